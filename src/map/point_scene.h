// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cmath>
#include <map>
#include <opencv2/core.hpp>
#include <random>
#include <vector>

#include "core/frame.h"
#include "core/random_unit.h"
#include "core/se3.h"
#include "core/test_camera.h"
#include "map/map.h"
#include "map/test_frame.h"

namespace dxslam {

/// A cloud of described points in front of a wall, and what a camera sees of it: test scenes for
/// the layers above features, which need no images. Everything follows from the seed.
class PointScene {
 public:
  explicit PointScene(int points = 2500, unsigned seed = 7) : generator_(seed) {
    std::uniform_real_distribution<double> x(-4.0, 4.0), y(-1.5, 1.5), z(2.5, 4.5);
    descriptors_.create(points, kDimension, CV_32F);
    for (int i = 0; i < points; ++i) {
      points_.emplace_back(x(generator_), y(generator_), z(generator_));
      cv::Mat(random_unit(generator_, kDimension)).reshape(1, 1).copyTo(descriptors_.row(i));
    }
  }

  const Camera& camera() const { return camera_; }
  const std::vector<Eigen::Vector3d>& points() const { return points_; }
  DescriptorTraits traits() const { return {false, descriptors_.cols, 0.6F, 0}; }

  /// Pose `t` of 0...1 along a gentle sideways path that starts at the origin.
  static SE3 pose(double t) {
    Vector6d motion;
    motion << 2.0 * t, 0.1 * std::sin(6.0 * t), 0.3 * t, 0.05 * std::sin(5.0 * t), -0.2 * t, 0.0;
    return {so3_exp(motion.tail<3>()), motion.head<3>()};
  }

  /// Keypoints of all points in view with pixel noise; `depth_share` of them have depth, and
  /// `source` (if given) receives the point behind each keypoint.
  FramePtr frame(std::int64_t index, const SE3& world_from_camera, double noise = 0.3,
                 double depth_share = 0.8, std::vector<int>* source = nullptr) {
    auto frame = empty_test_frame(index);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform;
    const SE3 camera_from_world = world_from_camera.inverse();
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const auto offset = [&]() -> Eigen::Vector2d {
        return noise * Eigen::Vector2d(normal(generator_), normal(generator_));
      };
      if (!add_test_keypoint(camera_, camera_from_world * points_[i], offset,
                             descriptors_.row(static_cast<int>(i)), *frame)) {
        continue;
      }
      if (uniform(generator_) >= depth_share) frame->depths.back() = 0.0F;
      if (source != nullptr) source->push_back(static_cast<int>(i));
    }
    return frame;
  }

 private:
  static constexpr int kDimension = 32;

  std::mt19937 generator_;
  Camera camera_ = test_camera();
  std::vector<Eigen::Vector3d> points_;
  cv::Mat descriptors_;
};

/// Makes each keypoint of a keyframe an observation of the map point that stands for its point of
/// the scene; `point_of` knows those that there are, and gets the new ones.
inline void bind_to_points(KeyframeId keyframe, const std::vector<int>& source,
                           const PointScene& scene, const SE3& world_from_scene,
                           std::map<int, PointId>& point_of, Map& map) {
  for (std::size_t i = 0; i < source.size(); ++i) {
    const auto keypoint = static_cast<std::uint32_t>(i);
    const auto it = point_of.find(source[i]);
    if (it != point_of.end()) {
      map.add_observation(it->second, keyframe, keypoint);
      continue;
    }
    const Eigen::Vector3d& point = scene.points()[static_cast<std::size_t>(source[i])];
    point_of[source[i]] = map.add_point(world_from_scene * point, keyframe, keypoint);
  }
}

}  // namespace dxslam
