// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors

// The system in threads against the same system in one: threads may add speed, not errors.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "map/point_scene.h"
#include "slam/system.h"

namespace dxslam {
namespace {

constexpr int kFrames = 60;

// There and back along the path of the scene.
double place(int index) {
  const double t = 2.0 * index / (kFrames - 1);
  return t <= 1.0 ? t : 2.0 - t;
}

// A recording without images: the colour image holds the index of a frame, by which the extractor
// finds the keypoints that belong to it.
class Recording {
 public:
  Recording() : scene_(1200) {
    for (int i = 0; i < kFrames; ++i) add(i);
  }

  const Camera& camera() const { return scene_.camera(); }
  DescriptorTraits traits() const {
    DescriptorTraits traits = scene_.traits();
    traits.global_dimension = 2;
    return traits;
  }
  const std::vector<RgbdImage>& images() const { return images_; }
  const Features& features(const cv::Mat& color) const {
    std::int32_t index = 0;
    std::memcpy(&index, color.data, sizeof(index));
    return features_.at(static_cast<std::size_t>(index));
  }

 private:
  void add(int index) {
    const FramePtr frame = scene_.frame(index, PointScene::pose(place(index)));
    RgbdImage image;
    image.index = index;
    image.stamp = frame->stamp;
    image.color.create(1, sizeof(std::int32_t), CV_8UC1);
    const std::int32_t number = index;
    std::memcpy(image.color.data, &number, sizeof(number));
    image.depth = cv::Mat::zeros(camera().height, camera().width, CV_32FC1);
    Features features;
    for (std::size_t i = 0; i < frame->size(); ++i) {
      const Eigen::Vector2f& p = frame->pixels[i];
      features.keypoints.push_back({p.x(), p.y(), 1.0F, 1.0F});
      // Every other keypoint is without a reading, and may be triangulated.
      if (i % 2 == 0) depth_at(image.depth, p) = frame->depths[i];
    }
    features.descriptors = frame->descriptors.clone();
    features.encoder.create(1, 1, CV_32FC1);
    features.encoder.at<float>(0, 0) = static_cast<float>(place(index));
    images_.push_back(image);
    features_.push_back(features);
  }
  static float& depth_at(cv::Mat& depth, const Eigen::Vector2f& p) {
    const auto within = [](float x, int size) {
      return std::clamp(static_cast<int>(std::lround(x)), 0, size - 1);
    };
    return depth.at<float>(within(p.y(), depth.rows), within(p.x(), depth.cols));
  }

  PointScene scene_;
  std::vector<RgbdImage> images_;
  std::vector<Features> features_;
};

const Recording& recording() {
  static const Recording made;
  return made;
}

class RecordingExtractor : public FeatureExtractor {
 public:
  explicit RecordingExtractor(int broken = -1) : broken_(broken) {}
  const std::string& name() const override { return name_; }
  const DescriptorTraits& traits() const override { return traits_; }
  Features extract(const cv::Mat& image, bool) override {
    if (count_++ == broken_) throw std::runtime_error("broken image");
    return recording().features(image);
  }
  std::vector<float> global_of(const cv::Mat& encoder) override {
    const float angle = encoder.at<float>(0, 0);
    return {std::cos(angle), std::sin(angle)};
  }

 private:
  const std::string name_ = "recording";
  const DescriptorTraits traits_ = recording().traits();
  const int broken_;
  int count_ = 0;
};

SystemOptions options(bool deterministic) {
  SystemOptions options;
  options.features = "recording";
  options.deterministic = deterministic;
  return options;
}

struct Outcome {
  Trajectory trajectory;
  std::size_t keyframes = 0;
  std::size_t points = 0;
};

Outcome run(const SystemOptions& options) {
  System system(recording().camera(), std::make_unique<RecordingExtractor>(), options);
  for (const RgbdImage& image : recording().images()) system.process(image);
  system.finish();
  return {system.trajectory(), system.map().keyframe_count(), system.map().point_count()};
}

// Root mean square distance to the true path; the first camera is the origin of both.
double error_of(const Trajectory& trajectory) {
  double sum = 0.0;
  for (const StampedPose& pose : trajectory) {
    const int index = static_cast<int>(std::lround(30.0 * pose.stamp));
    const double d = translation_distance(pose.world_from_camera, PointScene::pose(place(index)));
    sum += d * d;
  }
  return std::sqrt(sum / static_cast<double>(trajectory.size()));
}

TEST(SystemThreads, AreAsAccurateAsOneThread) {
  const Outcome serial = run(options(true));
  ASSERT_EQ(serial.trajectory.size(), kFrames);
  EXPECT_LT(error_of(serial.trajectory), 0.01);
  ASSERT_GT(serial.keyframes, 4U);
  // Which local map a frame is tracked against depends on who was faster, so no two runs are equal.
  for (const int queued : {1, 2, 8}) {
    SystemOptions threaded_options = options(false);
    threaded_options.queued_frames = queued;
    threaded_options.queued_keyframes = queued;
    const Outcome threaded = run(threaded_options);
    ASSERT_EQ(threaded.trajectory.size(), kFrames) << queued;
    EXPECT_LT(error_of(threaded.trajectory), 0.01) << queued;
    const double ratio =
        static_cast<double>(threaded.keyframes) / static_cast<double>(serial.keyframes);
    EXPECT_GT(ratio, 0.5) << queued;
    EXPECT_LT(ratio, 2.0) << queued;
    for (std::size_t i = 0; i < serial.trajectory.size(); ++i) {
      EXPECT_EQ(threaded.trajectory[i].stamp, serial.trajectory[i].stamp);
      EXPECT_LT(translation_distance(threaded.trajectory[i].world_from_camera,
                                     serial.trajectory[i].world_from_camera),
                0.02)
          << i;
    }
  }
}

TEST(SystemThreads, OneThreadRepeatsItselfToTheBit) {
  const Outcome a = run(options(true));
  const Outcome b = run(options(true));
  EXPECT_EQ(a.keyframes, b.keyframes);
  EXPECT_EQ(a.points, b.points);
  ASSERT_EQ(a.trajectory.size(), b.trajectory.size());
  for (std::size_t i = 0; i < a.trajectory.size(); ++i) {
    EXPECT_EQ(a.trajectory[i].world_from_camera.matrix(),
              b.trajectory[i].world_from_camera.matrix());
  }
}

TEST(SystemThreads, LiveInputIsDroppedRatherThanWaitedFor) {
  SystemOptions live = options(false);
  live.queued_frames = 1;
  std::atomic<int> seen{0};
  System system(recording().camera(), std::make_unique<RecordingExtractor>(), live,
                [&](const TrackedFrame&) { ++seen; });
  int taken = 0;
  for (const RgbdImage& image : recording().images()) taken += system.try_process(image) ? 1 : 0;
  system.finish();
  EXPECT_GE(taken, 1);
  EXPECT_EQ(seen, taken);
  EXPECT_EQ(system.frames().size(), static_cast<std::size_t>(taken));
}

TEST(SystemThreads, FindThemselvesAgainInANewRecordingOfTheSamePlace) {
  for (const bool deterministic : {true, false}) {
    System system(recording().camera(), std::make_unique<RecordingExtractor>(),
                  options(deterministic));
    for (const RgbdImage& image : recording().images()) system.process(image);
    system.begin_sequence();
    for (int i = 20; i < 40; ++i) {
      RgbdImage again = recording().images()[static_cast<std::size_t>(i)];
      again.stamp += 100.0;
      system.process(again);
    }
    system.finish();
    EXPECT_EQ(system.components().size(), 1U) << deterministic;
    ASSERT_EQ(system.trajectory().size(), kFrames + 20U) << deterministic;
    for (const StampedPose& pose : system.trajectory()) {
      const double stamp = pose.stamp > 50.0 ? pose.stamp - 100.0 : pose.stamp;
      const int index = static_cast<int>(std::lround(30.0 * stamp));
      EXPECT_LT(translation_distance(pose.world_from_camera, PointScene::pose(place(index))), 0.03)
          << index;
    }
  }
}

TEST(SystemThreads, HandOnWhatWentWrongInside) {
  const auto feed = [](int broken) {
    System system(recording().camera(), std::make_unique<RecordingExtractor>(broken),
                  options(false));
    for (const RgbdImage& image : recording().images()) system.process(image);
    system.finish();
  };
  EXPECT_THROW(feed(0), std::runtime_error);
  EXPECT_THROW(feed(kFrames / 2), std::runtime_error);
  EXPECT_THROW(feed(kFrames - 1), std::runtime_error);
  EXPECT_NO_THROW(feed(kFrames));
}

TEST(SystemThreads, EndWithoutFinish) {
  for (const int fed : {0, 1, 5, 30}) {
    System system(recording().camera(), std::make_unique<RecordingExtractor>(), options(false));
    for (int i = 0; i < fed; ++i) system.process(recording().images()[static_cast<std::size_t>(i)]);
  }
}

}  // namespace
}  // namespace dxslam
