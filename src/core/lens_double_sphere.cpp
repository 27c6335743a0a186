// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include <cmath>

#include "core/lens.h"

// Usenko, Demmel, Cremers: The Double Sphere Camera Model (3DV 2018), equations 40 to 50.

namespace dxslam {
namespace {

Eigen::Vector2d distort(const Lens::Parameters& parameters, const Eigen::Vector2d& p,
                        Eigen::Matrix2d* jacobian) {
  const double xi = parameters[0];
  const double alpha = parameters[1];
  const double r2 = p.squaredNorm();
  const double d1 = std::sqrt(r2 + 1.0);
  const double shifted = xi * d1 + 1.0;
  const double d2 = std::sqrt(r2 + shifted * shifted);
  const double below = alpha * d2 + (1.0 - alpha) * shifted;
  if (jacobian != nullptr) {
    const double shifted_slope = xi / d1;  // by r2 / 2
    const double d2_slope = (1.0 + shifted * shifted_slope) / d2;
    const double slope = alpha * d2_slope + (1.0 - alpha) * shifted_slope;
    *jacobian = Eigen::Matrix2d::Identity() / below - slope / (below * below) * p * p.transpose();
  }
  return p / below;
}

std::optional<Eigen::Vector2d> undistort(const Lens::Parameters& parameters,
                                         const Eigen::Vector2d& p) {
  const double xi = parameters[0];
  const double alpha = parameters[1];
  const double r2 = p.squaredNorm();
  const double root2 = 1.0 - (2.0 * alpha - 1.0) * r2;
  if (!(root2 >= 0.0)) return std::nullopt;
  const double mz = (1.0 - alpha * alpha * r2) / (alpha * std::sqrt(root2) + 1.0 - alpha);
  const double inner2 = mz * mz + (1.0 - xi * xi) * r2;
  if (!(inner2 >= 0.0)) return std::nullopt;
  const double k = (mz * xi + std::sqrt(inner2)) / (mz * mz + r2);
  const double z = k * mz - xi;
  if (!(z > 0.0)) return std::nullopt;
  return k / z * p;
}

}  // namespace

const LensModel kDoubleSphere = {"double_sphere", {"xi", "alpha"}, true, true, nullptr, 0,
                                 distort,         undistort};

}  // namespace dxslam
