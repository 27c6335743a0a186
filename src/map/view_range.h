// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <numbers>
#include <optional>

#include "core/camera.h"
#include "map/map_types.h"

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

/// Where the points of a map should appear to a camera. One object serves one pose of it; it refers
/// to the camera.
class PointPredictor {
 public:
  PointPredictor(const Camera& camera, const SE3& world_from_camera, const ViewRange& range)
      : camera_(camera),
        camera_from_world_(world_from_camera.inverse()),
        centre_(world_from_camera.translation()),
        range_(range) {}

  struct Place {
    Eigen::Vector2d pixel;
    double depth = 0.0;    ///< metres along the camera's z
    double stretch = 1.0;  ///< Camera::stretch() there
  };
  /// Empty if the point is out of view or seen from out of the range. Arguments as in MapPoint.
  std::optional<Place> place_of(const Eigen::Vector3d& position, const Eigen::Vector3d& normal,
                                float usual_distance) const {
    const Eigen::Vector3d p = camera_from_world_ * position;
    const std::optional<Eigen::Vector2d> pixel = camera_.project_into_view(p);
    if (!pixel || !range_.contains(centre_, position, normal, usual_distance)) return std::nullopt;
    return Place{*pixel, p.z(), camera_.stretch(*pixel)};
  }
  std::optional<Place> place_of(const MapPoint& point) const {
    return place_of(point.position, point.normal, point.distance);
  }

 private:
  const Camera& camera_;
  SE3 camera_from_world_;
  Eigen::Vector3d centre_;
  ViewRange range_;
};

}  // namespace dxslam
