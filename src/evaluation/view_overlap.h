// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

#include "core/camera.h"
#include "core/se3.h"

namespace dxslam {

/// What one depth image saw, thinned out.
class DepthView {
 public:
  /// `depth` is CV_32FC1 metres, of the camera's size; 0 where there is no reading.
  DepthView(const cv::Mat& depth, const Camera& camera, const SE3& world_from_camera);

  /// Share of this view's points that lie in the other image and on the surface it saw there
  /// (within 10 % of the distance). Points where the other has no reading do not count; 0 if there
  /// are none that do.
  double share_seen_by(const DepthView& other) const;

 private:
  // What was seen along the ray to a point in the camera frame: 0 = no reading, -1 = not in the
  // image. Distortion is passed over: it moves less than the share that is asked for.
  float depth_at(const Eigen::Vector3d& point) const;

  Camera camera_;
  SE3 camera_from_world_;
  cv::Mat depth_;                        // every kStep-th pixel
  std::vector<Eigen::Vector3f> points_;  // in the world, metres
};

/// Whether at least `least` of either view is seen by the other.
bool views_overlap(const DepthView& a, const DepthView& b, double least);

}  // namespace dxslam
