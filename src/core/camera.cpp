// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "core/camera.h"

#include <fmt/format.h>

#include <cmath>

#include "core/error.h"

namespace dxslam {
namespace {

// Distorted normalised image coordinates of ideal ones.
Eigen::Vector2d distort_normalised(const Camera& c, const Eigen::Vector2d& x) {
  const double r2 = x.squaredNorm();
  const double radial = 1.0 + r2 * (c.k1 + r2 * (c.k2 + r2 * c.k3));
  const double xy = x.x() * x.y();
  return {x.x() * radial + 2.0 * c.p1 * xy + c.p2 * (r2 + 2.0 * x.x() * x.x()),
          x.y() * radial + c.p1 * (r2 + 2.0 * x.y() * x.y()) + 2.0 * c.p2 * xy};
}

}  // namespace

void Camera::validate(const std::string& where) const {
  const auto check = [&](const char* name, double value, double min, double max) {
    if (value >= min && value <= max) return;
    throw InputError(
        fmt::format("{}: camera {} is {}, expected {} to {}", where, name, value, min, max));
  };
  check("width", width, 16, 16384);
  check("height", height, 16, 16384);
  check("fx", fx, 1.0, 1e5);
  check("fy", fy, 1.0, 1e5);
  check("cx", cx, -width, 2.0 * width);
  check("cy", cy, -height, 2.0 * height);
  for (const double k : {k1, k2, p1, p2, k3}) check("distortion", k, -100.0, 100.0);
  check("fps", fps, 1e-3, 1e4);
  check("depth_factor", depth_factor, 1e-3, 1e6);
  check("depth_baseline", depth_baseline, 1e-4, 10.0);
  check("disparity_noise", disparity_noise, 1e-3, 100.0);
  check("max_depth", max_depth, 0.01, 1e4);
  check("readout_time", readout_time, 0.0, 1.0);
}

Eigen::Vector2d Camera::undistort(const Eigen::Vector2d& pixel) const {
  if (!has_distortion()) return pixel;
  const Eigen::Vector2d target((pixel.x() - cx) / fx, (pixel.y() - cy) / fy);
  Eigen::Vector2d x = target;
  // Fixed-point iteration; converges fast for the lenses of RGB-D cameras.
  for (int i = 0; i < 20; ++i) {
    const Eigen::Vector2d step = target - distort_normalised(*this, x);
    x += step;
    if (step.squaredNorm() < 1e-20) break;
  }
  return {fx * x.x() + cx, fy * x.y() + cy};
}

Eigen::Vector2d Camera::distort(const Eigen::Vector2d& pixel) const {
  if (!has_distortion()) return pixel;
  const Eigen::Vector2d d =
      distort_normalised(*this, {(pixel.x() - cx) / fx, (pixel.y() - cy) / fy});
  return {fx * d.x() + cx, fy * d.y() + cy};
}

}  // namespace dxslam
