// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

#include "core/camera.h"
#include "core/se3.h"

namespace dxslam {

/// The camera of a depth sensor whose images are not registered to colour: a pinhole of its own,
/// beside the colour camera. Field `depth_camera` of a camera file.
struct DepthCamera {
  int width = 0, height = 0;            ///< pixels; 0 = as the colour image
  double fx = 0.0, fy = 0.0;            ///< pixels; 0 = depth images are registered already
  double cx = 0.0, cy = 0.0;            ///< pixels
  double x = 0.0, y = 0.0, z = 0.0;     ///< metres, where it is in the frame of the colour camera
  double rx = 0.0, ry = 0.0, rz = 0.0;  ///< radians, rotation vector of color_from_depth

  Lens lens;  ///< no field of a camera file: as bags say it

  bool registered() const { return fx == 0.0; }
  SE3 color_from_depth() const { return {so3_exp({rx, ry, rz}), Eigen::Vector3d(x, y, z)}; }

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit("width", self.width, {0, 16384}, "pixels", "image width; 0: that of the colour image");
    visit("height", self.height, {0, 16384}, "pixels", "image height");
    visit("fx", self.fx, {0, 1e5}, "pixels", "focal length; 0: depth is registered to colour");
    visit("fy", self.fy, {0, 1e5}, "pixels", "focal length");
    visit("cx", self.cx, {-16384, 32768}, "pixels", "principal point");
    visit("cy", self.cy, {-16384, 32768}, "pixels", "principal point");
    visit("x", self.x, {-10, 10}, "m", "position in the frame of the colour camera");
    visit("y", self.y, {-10, 10}, "m", "position in the frame of the colour camera");
    visit("z", self.z, {-10, 10}, "m", "position in the frame of the colour camera");
    visit("rx", self.rx, {-4, 4}, "rad", "rotation vector from depth to colour camera");
    visit("ry", self.ry, {-4, 4}, "rad", "rotation vector from depth to colour camera");
    visit("rz", self.rz, {-4, 4}, "rad", "rotation vector from depth to colour camera");
  }
};

/// Turns raw depth images into those that the colour camera would have taken: every reading is
/// lifted to a point, moved and projected, lens distortion included; where several meet the
/// nearest stays. Readings of 0 and 65535 are none. Safe to share between threads.
class DepthRegistration {
 public:
  /// `depth` must not be registered().
  DepthRegistration(const Camera& color, const DepthCamera& depth);

  /// The size of raw depth images.
  cv::Size raw_size() const { return raw_size_; }
  /// CV_16UC1 of raw_size() to CV_16UC1 of the colour camera's size, both in units of
  /// 1 / depth_factor metres.
  cv::Mat operator()(const cv::Mat& raw) const;

 private:
  void splat(const Eigen::Vector3d& point, cv::Mat& registered) const;

  Camera color_;
  cv::Size raw_size_;
  SE3 color_from_depth_;
  double half_footprint_ = 0.5;        // colour pixels around a reading that it fills
  std::vector<Eigen::Vector3f> rays_;  // of each depth pixel, turned to the colour camera, depth 1
};

}  // namespace dxslam
