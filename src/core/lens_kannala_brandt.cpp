// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/lens.h"

// Kannala and Brandt 2006, with the four terms of OpenCV's fisheye module: the distance from the
// principal point is a polynomial of the angle from the axis, theta.

namespace dxslam {
namespace {

double radius_of(const Lens::Parameters& k, double theta) {
  const double t2 = theta * theta;
  return theta * (1.0 + t2 * (k[0] + t2 * (k[1] + t2 * (k[2] + t2 * k[3]))));
}

double slope_at(const Lens::Parameters& k, double theta) {
  const double t2 = theta * theta;
  return 1.0 + t2 * (3.0 * k[0] + t2 * (5.0 * k[1] + t2 * (7.0 * k[2] + t2 * 9.0 * k[3])));
}

Eigen::Vector2d distort(const Lens::Parameters& k, const Eigen::Vector2d& p,
                        Eigen::Matrix2d* jacobian) {
  const double r2 = p.squaredNorm();
  const double r = std::sqrt(r2);
  if (r < 1e-8) {
    if (jacobian != nullptr) jacobian->setIdentity();
    return p;
  }
  const double theta = std::atan(r);
  const double scale = radius_of(k, theta) / r;
  if (jacobian != nullptr) {
    const double along = slope_at(k, theta) / (1.0 + r2);  // of the radius, by r
    *jacobian = scale * Eigen::Matrix2d::Identity() + (along - scale) / r2 * p * p.transpose();
  }
  return scale * p;
}

std::optional<Eigen::Vector2d> undistort(const Lens::Parameters& k, const Eigen::Vector2d& p) {
  constexpr double kHalfTurn = std::numbers::pi / 2.0;
  const double radius = p.norm();
  if (radius < 1e-8) return p;
  // The first angle that appears at this radius, and only up to where the polynomial turns down:
  // fitted to the angles of an image, it may do so anywhere beyond them.
  constexpr double kStep = kHalfTurn / 30.0;
  double low = 0.0;
  double high = kStep;
  while (!(radius_of(k, high) >= radius)) {
    if (!(slope_at(k, high) > 0.0) || high >= kHalfTurn) return std::nullopt;
    low = high;
    high = std::min(high + kStep, kHalfTurn);
  }
  // By bisection where Newton's step leaves the bracket.
  double theta = 0.5 * (low + high);
  for (int i = 0; i < 60; ++i) {
    const double error = radius_of(k, theta) - radius;
    (error > 0.0 ? high : low) = theta;
    double next = theta - error / slope_at(k, theta);
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (std::abs(next - theta) < 1e-14) break;
    theta = next;
  }
  return std::tan(theta) / radius * p;
}

}  // namespace

const LensModel kKannalaBrandt = {
    "kannala_brandt", {"k1", "k2", "k3", "k4"}, false, true, "OPENCV_FISHEYE", 4, distort,
    undistort};

}  // namespace dxslam
