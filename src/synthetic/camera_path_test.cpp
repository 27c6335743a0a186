// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "synthetic/camera_path.h"

#include <gtest/gtest.h>

namespace dxslam {
namespace {

constexpr double kDegrees = 180.0 / 3.14159265358979;

class EveryScenePath : public testing::TestWithParam<std::string> {};

TEST_P(EveryScenePath, IsSmoothAndNoFasterThanAllowed) {
  const Layout layout = make_layout(GetParam(), 1);
  PathOptions options;
  options.shake = 0.0;
  const CameraPath path(layout, options, 1);
  const double dt = 1.0 / 30.0;
  SE3 last = path.world_from_camera(0.0);
  for (double t = dt; t < path.duration(); t += dt) {
    const SE3 next = path.world_from_camera(t);
    ASSERT_LE(translation_distance(last, next) / dt, 1.05 * layout.natural_speed) << "at " << t;
    ASSERT_LE(rotation_angle(last, next) / dt * kDegrees, 41.0) << "at " << t;
    last = next;
  }
}

TEST_P(EveryScenePath, ReturnsToWhereItBegan) {
  const Layout layout = make_layout(GetParam(), 1);
  const CameraPath path(layout, PathOptions(), 1);
  const SE3 start = path.world_from_camera(0.0);
  double nearest = 1e9;
  for (double t = 0.7 * path.duration(); t < path.duration(); t += 0.05) {
    nearest = std::min(nearest, translation_distance(start, path.world_from_camera(t)));
  }
  EXPECT_LT(nearest, 0.05);
}

TEST_P(EveryScenePath, ReverseVisitsTheSamePlacesLookingTheOtherWay) {
  const Layout layout = make_layout(GetParam(), 1);
  PathOptions options;
  options.shake = 0.0;
  const CameraPath forward(layout, options, 1);
  options.reverse = true;
  const CameraPath backward(layout, options, 1);
  const auto time_at = [](const CameraPath& path, double length) {
    double low = 0.0, high = path.duration();
    while (high - low > 1e-6) {
      const double middle = 0.5 * (low + high);
      (path.length_at(middle) < length ? low : high) = middle;
    }
    return low;
  };
  for (const double part : {0.1, 0.37, 0.8}) {
    const double length = part * forward.length();
    const SE3 there = forward.world_from_camera(time_at(forward, length));
    const SE3 back = backward.world_from_camera(time_at(backward, backward.length() - length));
    EXPECT_LT(translation_distance(there, back), 0.03);
    const Eigen::Vector3d look = there.rotation() * Eigen::Vector3d::UnitZ();
    const Eigen::Vector3d look_back = back.rotation() * Eigen::Vector3d::UnitZ();
    EXPECT_LT(look.head<2>().normalized().dot(look_back.head<2>().normalized()), -0.999);
    EXPECT_NEAR(look.z(), look_back.z(), 0.01);
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, EveryScenePath, testing::ValuesIn(scene_names()),
                         [](const auto& scene) { return scene.param; });

TEST(CameraPath, CorridorIsALoopOfMoreThan200Metres) {
  const Layout layout = make_layout("corridor", 1);
  const CameraPath path(layout, PathOptions(), 1);
  EXPECT_GT(path.length() - layout.overlap, 200.0);
}

TEST(CameraPath, StandsStillFirst) {
  const CameraPath path(make_layout("room", 1), PathOptions(), 1);
  const SE3 start = path.world_from_camera(0.0);
  EXPECT_LT(translation_distance(start, path.world_from_camera(0.4)), 0.005);
  EXPECT_GT(translation_distance(start, path.world_from_camera(3.0)), 0.3);
}

TEST(CameraPath, LooksLevelAlongThePathFromTheGivenHeight) {
  PathOptions options;
  options.shake = 0.0;
  options.height = 0.6;
  options.raise = 0.1;
  const CameraPath path(make_layout("corridor", 1), options, 1);
  const SE3 pose = path.world_from_camera(20.0);
  EXPECT_NEAR(pose.translation().z(), 0.7, 1e-9);
  EXPECT_NEAR((pose.rotation() * Eigen::Vector3d::UnitX()).z(), 0.0, 1e-9);  // no roll
  EXPECT_LT((pose.rotation() * Eigen::Vector3d::UnitY()).z(), -0.9);         // y is down
}

TEST(CameraPath, AnotherWalkTakesTheSameWayAndLooksElsewhere) {
  const Layout layout = make_layout("room", 1);
  PathOptions options;
  const CameraPath first(layout, options, 1);
  options.walk = 5;
  const CameraPath second(layout, options, 1);
  const CameraPath again(layout, options, 1);
  EXPECT_NEAR(first.length(), second.length(), 1e-9);
  const auto pose_at = [](const CameraPath& path, double length) {
    double time = 0.0;
    while (path.length_at(time) < length) time += 0.01;
    return path.world_from_camera(time);
  };
  double largest_turn = 0.0;
  for (double length = 0.5; length < first.length(); length += 0.5) {
    const SE3 a = pose_at(first, length), b = pose_at(second, length);
    EXPECT_LT(translation_distance(a, b), 0.1);
    largest_turn = std::max(largest_turn, rotation_angle(a, b) * kDegrees);
    EXPECT_EQ(b.matrix(), pose_at(again, length).matrix());
  }
  EXPECT_GT(largest_turn, 8.0);
}

TEST(CameraPath, SidewaysShiftsToTheRight) {
  PathOptions options;
  options.shake = 0.0;
  const Layout layout = make_layout("corridor", 1);
  const SE3 plain = CameraPath(layout, options, 1).world_from_camera(0.0);
  options.sideways = 0.3;
  const SE3 shifted = CameraPath(layout, options, 1).world_from_camera(0.0);
  const Eigen::Vector3d in_camera = plain.inverse() * shifted.translation();
  EXPECT_NEAR(in_camera.norm(), 0.3, 0.01);
  EXPECT_GT(in_camera.x(), 0.25);
}

}  // namespace
}  // namespace dxslam
