// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "grid/floor_scan.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace dxslam {
namespace {

constexpr float kDegrees = std::numbers::pi_v<float> / 180.0F;

}  // namespace

FloorScanner::FloorScanner(const Camera& camera, const GridOptions& options)
    : options_(options), width_(camera.width), height_(camera.height) {
  validate_options("grid", options_);
  for (int row = 0; row < height_; row += options_.pixel_step) {
    for (int column = 0; column < width_; column += options_.pixel_step) {
      const auto pixel = camera.undistort({column, row});
      if (!pixel) continue;
      directions_.push_back({row, column, camera.unproject(*pixel, 1.0).cast<float>()});
    }
  }
  bearings_.resize(static_cast<std::size_t>(std::ceil(360.0 / options_.bearing_step)));
}

FloorScan FloorScanner::scan(const cv::Mat& depth, const SE3& map_from_camera) {
  require(depth.type() == CV_32FC1 && depth.cols == width_ && depth.rows == height_,
          "FloorScanner: depth must be CV_32FC1 of the camera's size");
  for (Bearing& bearing : bearings_) {
    bearing.free_range = 0.0F;
    bearing.obstacles.clear();
  }
  const Eigen::Matrix3f rotation = map_from_camera.rotation().toRotationMatrix().cast<float>();
  const auto camera_height = static_cast<float>(map_from_camera.translation().z());
  for (const Direction& direction : directions_) {
    const float metres = depth.at<float>(direction.row, direction.column);
    if (!(metres > 0.0F)) continue;
    const Eigen::Vector3f point_in_camera = direction.ray * metres;
    const Eigen::Vector3f offset = rotation * point_in_camera;
    add(point_in_camera, offset, camera_height + offset.z());
  }
  FloorScan scan;
  const auto support = static_cast<std::size_t>(options_.min_support);
  for (const Bearing& bearing : bearings_) {
    if (bearing.obstacles.size() >= support) {
      scan.rays.push_back({bearing.obstacles[support - 1].second, true});
    } else if (bearing.free_range > 0.0F) {
      scan.rays.push_back({bearing.free_end, false});
    }
  }
  return scan;
}

void FloorScanner::add(const Eigen::Vector3f& point_in_camera, const Eigen::Vector3f& offset,
                       float height) {
  const auto max_range = static_cast<float>(options_.max_range);
  const float range = offset.head<2>().norm();
  const bool is_floor = height < static_cast<float>(options_.min_height);
  if (!(range > 0.0F) || height > static_cast<float>(options_.max_height) ||
      height < -static_cast<float>(options_.max_drop)) {
    return;
  }
  Bearing& bearing = bearing_of(offset);
  if (is_floor || range > max_range) {  // the way is free to there, or as far as it is looked
    const float free_range = std::min(range, max_range);
    if (free_range <= bearing.free_range) return;
    bearing.free_range = free_range;
    bearing.free_end = point_in_camera * (free_range / range);
    return;
  }
  auto& nearest = bearing.obstacles;
  const auto place = std::upper_bound(nearest.begin(), nearest.end(), range,
                                      [](float r, const auto& other) { return r < other.first; });
  nearest.insert(place, {range, point_in_camera});
  if (nearest.size() > static_cast<std::size_t>(options_.min_support)) nearest.pop_back();
}

FloorScanner::Bearing& FloorScanner::bearing_of(const Eigen::Vector3f& offset) {
  const float turn = std::atan2(offset.y(), offset.x()) / kDegrees + 180.0F;
  const auto number = static_cast<std::size_t>(turn / static_cast<float>(options_.bearing_step));
  return bearings_[std::min(number, bearings_.size() - 1)];
}

}  // namespace dxslam
