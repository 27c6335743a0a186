// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "core/rolling_shutter.h"

#include <algorithm>

namespace dxslam {

FramePtr without_rolling_shutter(const FramePtr& raw, const Camera& camera,
                                 const Vector6d& velocity) {
  auto frame = std::make_shared<Frame>(*raw);
  for (std::size_t i = 0; i < frame->size(); ++i) {
    const Eigen::Vector2d pixel = raw->pixels[i].cast<double>();
    // The undistorted row serves for the row of the sensor: they differ by a few pixels of
    // hundreds.
    const double row = std::clamp(pixel.y() / camera.height, 0.0, 1.0) - 0.5;
    const SE3 middle_from_row = SE3::exp(row * camera.readout_time * velocity);
    const bool has_depth = raw->has_depth(i);
    const Eigen::Vector3d seen = camera.unproject(pixel, has_depth ? raw->depths[i] : 1.0);
    const Eigen::Vector3d moved =
        has_depth ? middle_from_row * seen : Eigen::Vector3d(middle_from_row.rotation() * seen);
    if (moved.z() <= Camera::kNearest) continue;
    const Eigen::Vector2d corrected = camera.project(moved);
    if (!((corrected - pixel).norm() < camera.width)) continue;  // no camera turns as fast
    frame->pixels[i] = corrected.cast<float>();
    if (has_depth) frame->depths[i] = static_cast<float>(moved.z());
  }
  return frame;
}

}  // namespace dxslam
