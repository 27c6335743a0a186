// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <memory>
#include <opencv2/core.hpp>

#include "core/frame.h"

namespace dxslam {

/// A frame without keypoints, for made-up scenes; 30 a second.
inline std::shared_ptr<Frame> empty_test_frame(std::int64_t index) {
  auto frame = std::make_shared<Frame>();
  frame->index = index;
  frame->stamp = static_cast<double>(index) / 30.0;
  return frame;
}

/// Adds what the camera sees of a point in its frame: a keypoint that is off by `noise()` pixels,
/// with depth. False, and nothing is added, where the point is out of view.
template <class Noise>
bool add_test_keypoint(const Camera& camera, const Eigen::Vector3d& point_in_camera, Noise noise,
                       const cv::Mat& descriptor, Frame& frame) {
  if (point_in_camera.z() < 0.3) return false;
  const Eigen::Vector2d pixel = camera.project(point_in_camera) + noise();
  if (!camera.contains(pixel)) return false;
  frame.pixels.push_back(pixel.cast<float>());
  frame.depths.push_back(static_cast<float>(point_in_camera.z()));
  frame.scores.push_back(1.0F);
  frame.sigmas.push_back(1.0F);
  frame.descriptors.push_back(descriptor);
  return true;
}

}  // namespace dxslam
