// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <numbers>

namespace dxslam {

/// From where a map point can be expected to look as its descriptor says: roughly from where its
/// keyframes see it. Plain data.
class ViewRange {
 public:
  /// `max_angle` in degrees from the point's normal; the distance may be up to `max_distance_ratio`
  /// times longer or shorter than usual.
  ViewRange(double max_angle, double max_distance_ratio)
      : min_cosine_(std::cos(max_angle * std::numbers::pi / 180.0)),
        max_ratio_(max_distance_ratio) {}

  /// Whether it holds at the camera centre; all in world coordinates and metres, `normal` and
  /// `usual_distance` as in MapPoint.
  bool contains(const Eigen::Vector3d& centre, const Eigen::Vector3d& point,
                const Eigen::Vector3d& normal, float usual_distance) const {
    const Eigen::Vector3d ray = centre - point;
    const double distance = ray.norm();
    if (ray.dot(normal) < min_cosine_ * distance) return false;
    const double ratio = distance / static_cast<double>(usual_distance);
    return ratio <= max_ratio_ && ratio * max_ratio_ >= 1.0;
  }

 private:
  double min_cosine_;
  double max_ratio_;
};

}  // namespace dxslam
