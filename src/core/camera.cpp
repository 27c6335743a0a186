// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "core/camera.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/error.h"

namespace dxslam {
namespace {

// Of the plane at unit focal length.
const double kWidestTangent = std::tan(Camera::kWidestAngle * std::numbers::pi / 180.0);

// Whether a position of the image has one undistorted place, at which the lens does not fold the
// image.
bool is_undone_by(const Lens& lens, const Eigen::Vector2d& raw, const Eigen::Vector2d& ideal) {
  constexpr double kResidual = 2e-6;  // focal lengths
  constexpr double kFold = 1e-3;      // of the area of the distorted image
  Eigen::Matrix2d jacobian;
  const Eigen::Vector2d again = lens.model->distort(lens.parameters, ideal, &jacobian);
  return (again - raw).norm() < kResidual && jacobian.determinant() > kFold &&
         jacobian.trace() > 0.0;
}

std::string describe(const Lens& lens) {
  std::string text = fmt::format("the distortion ({})", lens.model->name);
  for (std::size_t i = 0; i < lens.model->parameter_count(); ++i) {
    text += fmt::format(" {} {}", lens.model->parameters[i], lens.parameters[i]);
  }
  return text;
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
  require(lens.model != nullptr, "a lens must have a model");
  for (std::size_t i = 0; i < lens.parameters.size(); ++i) {
    const char* name = lens.model->parameters[i];
    check(name != nullptr ? name : "lens parameter without a name", lens.parameters[i],
          name != nullptr ? -100.0 : 0.0, name != nullptr ? 100.0 : 0.0);
  }
  check("fps", fps, 1e-3, 1e4);
  check("depth_factor", depth_factor, 1e-3, 1e6);
  check("depth_baseline", depth_baseline, 1e-4, 10.0);
  check("disparity_noise", disparity_noise, 1e-3, 100.0);
  check("max_depth", max_depth, 0.01, 1e4);
  check("readout_time", readout_time, 0.0, 1.0);
  constexpr double kRounding = 1.05;  // of both numbers
  if (readout_time * fps > kRounding) {
    throw InputError(fmt::format(
        "{}: camera readout_time is {} s, expected at most the {:.4g} s from image to image "
        "that fps {} says",
        where, readout_time, 1.0 / fps, fps));
  }
  if (has_distortion()) measure_view(where);
}

void Camera::measure_view(const std::string& where) {
  constexpr int kParts = 32;  // of each side of the image
  constexpr int kPixels = (kParts + 1) * (kParts + 1);
  constexpr double kLeastUsed = 0.25;  // of the image; else the calibration is another camera's
  const double infinity = std::numeric_limits<double>::infinity();
  undistorted_ = {infinity, infinity, -infinity, -infinity};
  int used = 0;
  for (int i = 0; i < kPixels; ++i) {
    const int column = i % (kParts + 1);
    const int row = i / (kParts + 1);
    const Eigen::Vector2d raw((width - 1.0) * column / kParts, (height - 1.0) * row / kParts);
    const std::optional<Eigen::Vector2d> pixel = undistort(raw);
    if (!pixel && lens.model->is_fisheye) continue;
    if (!pixel || !is_undone_by(lens, normalised(raw), normalised(*pixel))) {
      throw InputError(fmt::format(
          "{}: {} cannot be undone at pixel ({:.0f}, {:.0f}), expected a lens that maps every "
          "pixel of the image to one direction",
          where, describe(lens), raw.x(), raw.y()));
    }
    ++used;
    undistorted_.left = std::min(undistorted_.left, pixel->x());
    undistorted_.top = std::min(undistorted_.top, pixel->y());
    undistorted_.right = std::max(undistorted_.right, pixel->x());
    undistorted_.bottom = std::max(undistorted_.bottom, pixel->y());
  }
  if (used < kLeastUsed * kPixels) {
    throw InputError(fmt::format(
        "{}: {} leaves {:.0f} % of the image within {} degrees of the axis, expected "
        "{:.0f} % at least",
        where, describe(lens), 100.0 * used / kPixels, kWidestAngle, 100.0 * kLeastUsed));
  }
}

bool Camera::sees_as(const Camera& o) const {
  return width == o.width && height == o.height && fx == o.fx && fy == o.fy && cx == o.cx &&
         cy == o.cy && lens == o.lens && depth_baseline == o.depth_baseline &&
         disparity_noise == o.disparity_noise;
}

bool Camera::operator==(const Camera& o) const {
  return sees_as(o) && fps == o.fps && depth_factor == o.depth_factor && max_depth == o.max_depth &&
         readout_time == o.readout_time;
}

std::optional<Eigen::Vector2d> Camera::undistort(const Eigen::Vector2d& pixel) const {
  if (!has_distortion()) return pixel;
  const auto ideal = lens.model->undistort(lens.parameters, normalised(pixel));
  if (!ideal || (lens.model->is_fisheye && !(ideal->norm() <= kWidestTangent))) return std::nullopt;
  return Eigen::Vector2d(fx * ideal->x() + cx, fy * ideal->y() + cy);
}

Eigen::Vector2d Camera::distort(const Eigen::Vector2d& pixel) const {
  if (!has_distortion()) return pixel;
  const Eigen::Vector2d d = lens.model->distort(lens.parameters, normalised(pixel), nullptr);
  return {fx * d.x() + cx, fy * d.y() + cy};
}

double Camera::stretch_of_lens(const Eigen::Vector2d& pixel) const {
  constexpr double kMost = 30.0;  // more than at the widest angle
  Eigen::Matrix2d jacobian;
  lens.model->distort(lens.parameters, normalised(pixel), &jacobian);
  const double area = jacobian.determinant();
  return area * kMost * kMost > 1.0 ? 1.0 / std::sqrt(area) : kMost;
}

}  // namespace dxslam
