// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "core/lens.h"
#include "core/lens_bending.h"

namespace dxslam {
namespace {

enum Parameter { kK1, kK2, kP1, kP2, kK3, kK4, kK5, kK6 };

Eigen::Vector2d distort(const Lens::Parameters& c, const Eigen::Vector2d& p,
                        Eigen::Matrix2d* jacobian) {
  const double r2 = p.squaredNorm();
  const double above = 1.0 + r2 * (c[kK1] + r2 * (c[kK2] + r2 * c[kK3]));
  const double below = 1.0 + r2 * (c[kK4] + r2 * (c[kK5] + r2 * c[kK6]));
  const double radial = above / below;
  const double above_slope = c[kK1] + r2 * (2.0 * c[kK2] + r2 * 3.0 * c[kK3]);  // by r2
  const double below_slope = c[kK4] + r2 * (2.0 * c[kK5] + r2 * 3.0 * c[kK6]);
  const double slope = 2.0 * (above_slope - radial * below_slope) / below;
  return bend_by_brown(p, radial, slope, c[kP1], c[kP2], jacobian);
}

std::optional<Eigen::Vector2d> undistort(const Lens::Parameters& c, const Eigen::Vector2d& p) {
  return undistort_by_newton(kRational, c, p);
}

}  // namespace

const LensModel kRational = {"rational",    {"k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"},
                             true,          false,
                             "FULL_OPENCV", 8,
                             distort,       undistort};

}  // namespace dxslam
