// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "synthetic/synthetic_sequence.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

#include "core/error.h"
#include "synthetic/sensor.h"
#include "synthetic/test_worlds.h"

namespace dxslam {
namespace {

using testing_worlds::quiet_room;

bool same(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() && cv::norm(a, b, cv::NORM_INF) == 0.0;
}

/// What two views of one point say about each other.
struct Agreement {
  int points = 0;
  double worst_depth = 0.0;         // metres
  std::vector<double> differences;  // grey levels
};

// Points of frame i, moved by the true poses to frame j, where all four pixels around show the same
// surface.
Agreement compare_views(const SyntheticSequence& sequence, std::size_t i, std::size_t j) {
  const Camera& camera = sequence.camera();
  const Rendering a = sequence.draw_ideal(i, 2), b = sequence.draw_ideal(j, 2);
  const cv::Mat image_a = develop_image(a.radiance, 1.0, 0.0, 0),
                image_b = develop_image(b.radiance, 1.0, 0.0, 0);
  const SE3 b_from_a = sequence.ground_truth()[j].world_from_camera.inverse() *
                       sequence.ground_truth()[i].world_from_camera;
  Agreement result;
  for (int y = 1; y < camera.height - 1; y += 2) {
    for (int x = 1; x < camera.width - 1; x += 2) {
      const Eigen::Vector3d point = b_from_a * camera.unproject({x, y}, a.depth.at<float>(y, x));
      if (point.z() < 0.1) continue;
      const Eigen::Vector2d pixel = camera.project(point);
      if (pixel.minCoeff() < 1 || pixel.x() > camera.width - 2 || pixel.y() > camera.height - 2)
        continue;
      const int col = static_cast<int>(pixel.x()), row = static_cast<int>(pixel.y());
      const double fx = pixel.x() - col, fy = pixel.y() - row;
      bool one_surface = true;
      double inverse_depth = 0.0, grey = 0.0;
      for (int k = 0; k < 4; ++k) {
        const int r = row + k / 2, c = col + k % 2;
        const double weight = (k % 2 != 0 ? fx : 1 - fx) * (k / 2 != 0 ? fy : 1 - fy);
        one_surface &= b.surface.at<int>(r, c) == a.surface.at<int>(y, x);
        inverse_depth += weight / b.depth.at<float>(r, c);
        grey += weight * image_b.at<cv::Vec3b>(r, c)[1];
      }
      if (!one_surface) continue;
      ++result.points;
      result.worst_depth = std::max(result.worst_depth, std::abs(1.0 / inverse_depth - point.z()));
      result.differences.push_back(std::abs(grey - image_a.at<cv::Vec3b>(y, x)[1]));
    }
  }
  std::sort(result.differences.begin(), result.differences.end());
  return result;
}

TEST(SyntheticSequence, GroundTruthFitsTheGeometryAndTheColours) {
  const SyntheticSequence sequence(quiet_room());
  for (const std::size_t i : {2U, 15U, 30U}) {
    const Agreement near = compare_views(sequence, i, i + 1);
    EXPECT_GT(near.points, 5000) << "frame " << i;
    EXPECT_LT(near.worst_depth, 1e-3) << "frame " << i;
    EXPECT_LT(near.differences[near.differences.size() / 2], 5.0) << "frame " << i;
    EXPECT_LT(near.differences[near.differences.size() * 9 / 10], 30.0) << "frame " << i;
  }
  // The loop closes: one of the last frames sees what the first one saw.
  const Trajectory& truth = sequence.ground_truth();
  std::size_t nearest = sequence.size() / 2;
  for (std::size_t i = nearest; i < sequence.size(); ++i) {
    if (translation_distance(truth[0].world_from_camera, truth[i].world_from_camera) <
        translation_distance(truth[0].world_from_camera, truth[nearest].world_from_camera)) {
      nearest = i;
    }
  }
  EXPECT_GT(compare_views(sequence, 0, nearest).points, 5000);
}

// The same place at the same moment, with and without a lens.
TEST(SyntheticSequence, ALensBendsWhatAPinholeSees) {
  SyntheticOptions options = quiet_room();
  options.frames = 1;
  const SyntheticSequence straight(options);
  const Rendering expected = straight.draw_ideal(0, 2);
  for (const LensModel* model : lens_models()) {
    options.lens = model->name;
    const SyntheticSequence bent(options);
    const Rendering seen = bent.draw_ideal(0, 2);
    ASSERT_EQ(seen.depth.size(), expected.depth.size());
    int compared = 0;
    int same = 0;
    for (int y = 4; y < seen.depth.rows; y += 4) {
      for (int x = 4; x < seen.depth.cols; x += 4) {
        const auto pixel = bent.camera().undistort({x, y});
        if (!pixel || !straight.camera().contains(*pixel)) continue;
        const float depth = expected.depth.at<float>(static_cast<int>(std::lround(pixel->y())),
                                                     static_cast<int>(std::lround(pixel->x())));
        ++compared;
        if (std::abs(depth - seen.depth.at<float>(y, x)) < 0.02F * depth) ++same;
      }
    }
    EXPECT_GT(compared, seen.depth.rows * seen.depth.cols / 32) << model->name;
    EXPECT_GT(same, 0.97 * compared) << model->name;
  }
  options.lens = "periscope";
  EXPECT_THROW(SyntheticSequence{options}, InputError);
}

TEST(SyntheticSequence, EqualOptionsGiveEqualFramesInAnyOrderWithAnyThreads) {
  SyntheticOptions options = quiet_room();
  options.factors = FactorOptions();
  options.factors.people = 1.0;
  options.factors.motion_blur = 1.0;
  SyntheticSequence first(options);
  options.threads = 1;
  SyntheticSequence second(options);
  ASSERT_EQ(first.size(), second.size());
  const auto last = second.read(20);
  for (const std::size_t i : {5U, 20U}) {
    const auto a = first.read(i), b = second.read(i);
    ASSERT_TRUE(a && b);
    EXPECT_TRUE(same(a->color, b->color));
    EXPECT_TRUE(same(a->depth, b->depth));
    EXPECT_EQ(a->stamp, i / options.fps);
  }
  EXPECT_TRUE(same(last->color, first.read(20)->color));
  EXPECT_FALSE(same(first.read(5)->color, first.read(6)->color));
}

TEST(SyntheticSequence, PeopleHideThingsAndChangeNothingElse) {
  SyntheticOptions options = quiet_room();
  options.factors.people = 1.0;
  const SyntheticSequence crowded(options);
  const CameraPath path(make_layout(options.scene, options.seed), options.path, options.seed);
  const int first_person = static_cast<int>(crowded.world().surfaces.size());
  int visited = 0, most = 0;
  for (std::size_t i = 0; i < crowded.size(); i += 2) {
    const StampedPose& pose = crowded.ground_truth()[i];
    EXPECT_EQ(translation_distance(pose.world_from_camera, path.world_from_camera(pose.stamp)),
              0.0);
    const Rendering a = render(crowded.world(), {}, crowded.camera(), pose.world_from_camera, {});
    const Rendering b = crowded.draw_ideal(i, 2);
    const cv::Mat people = b.surface >= first_person;
    cv::Mat beside;
    const int count = cv::countNonZero(people);
    visited += count > 0;
    most = std::max(most, count);
    cv::dilate(people, beside, cv::Mat());  // their outline is mixed with what is behind
    EXPECT_EQ(cv::norm(a.radiance, b.radiance, cv::NORM_INF, ~beside), 0.0);
    EXPECT_EQ(cv::norm(a.depth, b.depth, cv::NORM_INF, ~people), 0.0);
    EXPECT_EQ(cv::countNonZero(people & (b.depth > a.depth)), 0);
  }
  EXPECT_GT(visited, static_cast<int>(crowded.size()) / 6);
  EXPECT_GT(most, 320 * 240 / 25);
}

TEST(SyntheticSequence, IlluminationLeavesTheGeometry) {
  SyntheticOptions options = quiet_room();
  const SyntheticSequence day(options);
  options.factors.illumination = 0.8;
  const SyntheticSequence evening(options);
  const Rendering a = day.draw_ideal(10, 2), b = evening.draw_ideal(10, 2);
  EXPECT_TRUE(same(a.depth, b.depth));
  EXPECT_TRUE(same(a.surface, b.surface));
  const cv::Mat before = develop_image(a.radiance, 1.0, 0.0, 0),
                after = develop_image(b.radiance, 1.0, 0.0, 0);
  EXPECT_GT(cv::norm(before, after, cv::NORM_L1) / static_cast<double>(before.total() * 3), 10.0);
}

TEST(SyntheticSequence, ChangedObjectsLeaveThePathAndTheWalls) {
  SyntheticOptions options = quiet_room();
  const SyntheticSequence before(options);
  options.factors.changed_objects = 0.5;
  const SyntheticSequence after(options);
  double changed = 0.0, total = 0.0;
  for (const std::size_t i : {4U, 16U, 28U}) {
    EXPECT_EQ(rotation_angle(before.ground_truth()[i].world_from_camera,
                             after.ground_truth()[i].world_from_camera),
              0.0);
    const Rendering a = before.draw_ideal(i, 2), b = after.draw_ideal(i, 2);
    const cv::Mat image_a = develop_image(a.radiance, 1.0, 0.0, 0),
                  image_b = develop_image(b.radiance, 1.0, 0.0, 0);
    std::vector<int> differences;
    for (int y = 0; y < a.surface.rows; ++y) {
      for (int x = 0; x < a.surface.cols; ++x) {
        const int s = a.surface.at<int>(y, x), t = b.surface.at<int>(y, x);
        total += 1;
        changed += std::abs(image_a.at<cv::Vec3b>(y, x)[1] - image_b.at<cv::Vec3b>(y, x)[1]) > 30;
        if (s != t || before.world().surfaces[s].object >= 0) continue;
        EXPECT_EQ(a.depth.at<float>(y, x), b.depth.at<float>(y, x));
        differences.push_back(
            std::abs(image_a.at<cv::Vec3b>(y, x)[1] - image_b.at<cv::Vec3b>(y, x)[1]));
      }
    }
    ASSERT_GT(differences.size(), 5000U);
    std::sort(differences.begin(), differences.end());
    EXPECT_LE(differences[differences.size() / 2], 4);  // shadows of what moved remain
  }
  EXPECT_GT(changed / total, 0.1);
  EXPECT_LT(changed / total, 0.7);
}

TEST(SyntheticSequence, LowLightIsDarkAndGreyAndFramesLimitTheLength) {
  SyntheticOptions options = quiet_room();
  options.frames = 2;
  options.factors.low_light = 0.12;
  SyntheticSequence sequence(options);
  const auto image = sequence.read(1);
  ASSERT_EQ(image->color.type(), CV_8UC1);
  EXPECT_LT(cv::mean(image->color)[0], 20.0);
  EXPECT_EQ(image->depth.type(), CV_32FC1);
  EXPECT_EQ(sequence.size(), 2U);
  EXPECT_LT(sequence.path_length(), 0.5);
  EXPECT_THROW(sequence.draw(2, 1), ContractError);
}

TEST(SyntheticSequence, MotionBlurSoftensTheImageOnlyWhileMoving) {
  SyntheticOptions options = quiet_room();
  options.fps = 4.0;
  options.path.shake = 0.0;
  const SyntheticSequence sharp(options);
  options.factors.motion_blur = 2.0;
  const SyntheticSequence blurred(options);
  const auto sharpness = [](const cv::Mat& image) {
    cv::Mat edges;
    cv::Laplacian(image, edges, CV_32F);
    return cv::norm(edges, cv::NORM_L1);
  };
  EXPECT_GT(sharpness(blurred.draw(0, 2).color), 0.6 * sharpness(sharp.draw(0, 2).color));
  double ratio = 0.0;
  for (const std::size_t i : {20U, 30U, 40U}) {
    ratio += sharpness(blurred.draw(i, 2).color) / sharpness(sharp.draw(i, 2).color) / 3.0;
    EXPECT_TRUE(same(blurred.draw(i, 2).depth, sharp.draw(i, 2).depth));
  }
  EXPECT_LT(ratio, 0.6);
}

TEST(SyntheticSequence, RefusesOptionsOutOfRange) {
  SyntheticOptions options;
  options.factors.people = -1.0;
  EXPECT_THROW(SyntheticSequence{options}, InputError);
  options = SyntheticOptions();
  options.scene = "moon";
  EXPECT_THROW(SyntheticSequence{options}, InputError);
}

class EveryScene : public testing::TestWithParam<std::string> {};

TEST_P(EveryScene, HasPlentyOfCornersAndFreeSpaceInEveryView) {
  SyntheticOptions options;
  options.scene = GetParam();
  options.fps = GetParam() == "room" ? 0.5 : 0.08;
  options.factors.depth_noise = 0.0;
  SyntheticSequence sequence(options);
  ASSERT_GE(sequence.size(), 12U);
  const auto orb = cv::ORB::create(1000);
  for (std::size_t i = 0; i < sequence.size(); ++i) {
    const auto image = sequence.read(i);
    cv::Mat grey;
    cv::cvtColor(image->color, grey, cv::COLOR_BGR2GRAY);
    std::vector<cv::KeyPoint> keypoints;
    orb->detect(grey, keypoints);
    EXPECT_GE(keypoints.size(), 500U) << "frame " << i;
    const double mean = cv::mean(grey)[0];
    EXPECT_GT(mean, 60.0) << "frame " << i;
    EXPECT_LT(mean, 190.0) << "frame " << i;
    double nearest = 0.0;
    cv::minMaxLoc(image->depth, &nearest, nullptr, nullptr, nullptr, image->depth > 0);
    EXPECT_GT(nearest, 0.3) << "frame " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, EveryScene, testing::ValuesIn(scene_names()),
                         [](const auto& scene) { return scene.param; });

}  // namespace
}  // namespace dxslam
