// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/recordings/depth_registration.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include "core/error.h"

namespace dxslam {
namespace {

constexpr double kBehind = -1e9;  // of a reading where the lens sees nothing: never in view
constexpr std::uint16_t kInvalid = std::numeric_limits<std::uint16_t>::max();

}  // namespace

DepthRegistration::DepthRegistration(const Camera& color, const DepthCamera& depth)
    : color_(color),
      raw_size_(depth.width == 0 ? color.width : depth.width,
                depth.height == 0 ? color.height : depth.height),
      color_from_depth_(depth.color_from_depth()) {
  require(depth.fx > 0.0 && depth.fy > 0.0, "registration needs the depth camera's focal lengths");
  // A tenth more than half a pixel, so that turned and slanted surfaces stay closed.
  half_footprint_ = std::max({0.5, 0.55 * color.fx / depth.fx, 0.55 * color.fy / depth.fy});
  rays_.reserve(static_cast<std::size_t>(raw_size_.area()));
  for (int y = 0; y < raw_size_.height; ++y) {
    for (int x = 0; x < raw_size_.width; ++x) {
      const Eigen::Vector2d place((x - depth.cx) / depth.fx, (y - depth.cy) / depth.fy);
      const std::optional<Eigen::Vector2d> ideal =
          depth.lens.is_ideal() ? place : depth.lens.model->undistort(depth.lens.parameters, place);
      const Eigen::Vector3d ray = ideal ? color_from_depth_.rotation() * ideal->homogeneous()
                                        : Eigen::Vector3d(0.0, 0.0, kBehind);
      rays_.push_back(ray.cast<float>());
    }
  }
}

cv::Mat DepthRegistration::operator()(const cv::Mat& raw) const {
  require(raw.type() == CV_16UC1 && raw.size() == raw_size_,
          "raw depth must be CV_16UC1 and of the depth camera's size");
  cv::Mat registered(color_.height, color_.width, CV_16UC1, cv::Scalar(0));
  const Eigen::Vector3d shift = color_from_depth_.translation() * color_.depth_factor;
  auto ray = rays_.begin();
  for (int y = 0; y < raw.rows; ++y) {
    const auto* readings = raw.ptr<std::uint16_t>(y);
    for (int x = 0; x < raw.cols; ++x, ++ray) {
      if (readings[x] == 0 || readings[x] == kInvalid) continue;
      splat(ray->cast<double>() * readings[x] + shift, registered);
    }
  }
  return registered;
}

void DepthRegistration::splat(const Eigen::Vector3d& point, cv::Mat& registered) const {
  // A raw unit is the least depth that can be written down.
  if (point.z() < 1.0 || point.z() >= kInvalid) return;
  Eigen::Vector2d pixel = color_.project(point);
  if (color_.has_distortion()) {
    // Outside, the polynomial of the distortion may come back into the image.
    if (!color_.contains(pixel)) return;
    pixel = color_.distort(pixel);
  }
  // Half-open, so that a footprint of one pixel is the nearest pixel alone.
  const auto first = [this](double at) {
    return std::max(0, static_cast<int>(std::ceil(at - half_footprint_)));
  };
  const auto end = [this](double at, int size) {
    return std::min(size, static_cast<int>(std::ceil(at + half_footprint_)));
  };
  const auto depth = static_cast<std::uint16_t>(std::lround(point.z()));
  for (int y = first(pixel.y()); y < end(pixel.y(), color_.height); ++y) {
    auto* row = registered.ptr<std::uint16_t>(y);
    for (int x = first(pixel.x()); x < end(pixel.x(), color_.width); ++x) {
      if (row[x] == 0 || depth < row[x]) row[x] = depth;
    }
  }
}

}  // namespace dxslam
