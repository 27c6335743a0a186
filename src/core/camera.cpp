// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "core/camera.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"

namespace dxslam {
namespace {

// Distorted normalised image coordinates of ideal ones, and how they change with these.
Eigen::Vector2d distort_normalised(const Camera& c, const Eigen::Vector2d& p,
                                   Eigen::Matrix2d* jacobian = nullptr) {
  const double x = p.x();
  const double y = p.y();
  const double r2 = p.squaredNorm();
  const double radial = 1.0 + r2 * (c.k1 + r2 * (c.k2 + r2 * c.k3));
  if (jacobian != nullptr) {
    const double slope =
        2.0 * (c.k1 + r2 * (2.0 * c.k2 + r2 * 3.0 * c.k3));  // of radial, by r2 / 2
    const double mixed = x * y * slope + 2.0 * (c.p1 * x + c.p2 * y);
    *jacobian << radial + x * x * slope + 2.0 * c.p1 * y + 6.0 * c.p2 * x, mixed, mixed,
        radial + y * y * slope + 6.0 * c.p1 * y + 2.0 * c.p2 * x;
  }
  return {x * radial + 2.0 * c.p1 * x * y + c.p2 * (r2 + 2.0 * x * x),
          y * radial + c.p1 * (r2 + 2.0 * y * y) + 2.0 * c.p2 * x * y};
}

// Whether a pixel of the image has one undistorted place, at which the lens does not fold the
// image.
bool is_undistorted_by(const Camera& camera, const Eigen::Vector2d& raw,
                       const Eigen::Vector2d& undistorted) {
  constexpr double kResidual = 1e-3;  // pixels
  constexpr double kFold = 1e-3;      // of the area of the distorted image
  Eigen::Matrix2d jacobian;
  distort_normalised(
      camera,
      {(undistorted.x() - camera.cx) / camera.fx, (undistorted.y() - camera.cy) / camera.fy},
      &jacobian);
  return (camera.distort(undistorted) - raw).norm() < kResidual && jacobian.determinant() > kFold &&
         jacobian.trace() > 0.0;
}

}  // namespace

std::size_t PixelBox::cell_of(const Eigen::Vector2f& pixel, int columns, int rows) const {
  const auto part = [](double at, double size, int parts) {
    const double cell = at / size * parts;
    return cell > 0.0 ? static_cast<std::size_t>(std::min(cell, parts - 1.0)) : 0;
  };
  const std::size_t column =
      part(static_cast<double>(pixel.x()) - left, right - left + 1.0, columns);
  const std::size_t row = part(static_cast<double>(pixel.y()) - top, bottom - top + 1.0, rows);
  return row * static_cast<std::size_t>(columns) + column;
}

void Camera::prepare(const std::string& where) {
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
  if (!has_distortion()) return;
  constexpr int kParts = 32;  // of each side of the image
  const double infinity = std::numeric_limits<double>::infinity();
  undistorted_ = {infinity, infinity, -infinity, -infinity};
  for (int i = 0; i < (kParts + 1) * (kParts + 1); ++i) {
    const int column = i % (kParts + 1);
    const int row = i / (kParts + 1);
    const Eigen::Vector2d raw((width - 1.0) * column / kParts, (height - 1.0) * row / kParts);
    const Eigen::Vector2d pixel = undistort(raw);
    if (!is_undistorted_by(*this, raw, pixel)) {
      throw InputError(fmt::format(
          "{}: the distortion k1 {} k2 {} p1 {} p2 {} k3 {} cannot be undone at pixel ({:.0f}, "
          "{:.0f}), expected a lens that maps every pixel of the image to one direction",
          where, k1, k2, p1, p2, k3, raw.x(), raw.y()));
    }
    undistorted_.left = std::min(undistorted_.left, pixel.x());
    undistorted_.top = std::min(undistorted_.top, pixel.y());
    undistorted_.right = std::max(undistorted_.right, pixel.x());
    undistorted_.bottom = std::max(undistorted_.bottom, pixel.y());
  }
}

Eigen::Vector2d Camera::undistort(const Eigen::Vector2d& pixel) const {
  if (!has_distortion()) return pixel;
  const Eigen::Vector2d target((pixel.x() - cx) / fx, (pixel.y() - cy) / fy);
  Eigen::Vector2d x = target;
  Eigen::Matrix2d jacobian;
  for (int i = 0; i < 20; ++i) {  // Newton's method
    const Eigen::Vector2d residual = target - distort_normalised(*this, x, &jacobian);
    const Eigen::Vector2d step = jacobian.inverse() * residual;
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
