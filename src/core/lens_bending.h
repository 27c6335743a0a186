// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <Eigen/Core>

namespace dxslam {

/// Brown's form of distortion: `ideal` times a factor that depends on its distance from the axis,
/// and what a lens that is not parallel to the image adds (p1, p2). `slope` is the derivative of
/// the factor by half the squared distance; `jacobian`, if given, receives that of the result.
inline Eigen::Vector2d bend_by_brown(const Eigen::Vector2d& ideal, double factor, double slope,
                                     double p1, double p2, Eigen::Matrix2d* jacobian) {
  const double x = ideal.x();
  const double y = ideal.y();
  const double r2 = ideal.squaredNorm();
  if (jacobian != nullptr) {
    const double mixed = x * y * slope + 2.0 * (p1 * x + p2 * y);
    *jacobian << factor + x * x * slope + 2.0 * p1 * y + 6.0 * p2 * x, mixed, mixed,
        factor + y * y * slope + 6.0 * p1 * y + 2.0 * p2 * x;
  }
  return {x * factor + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x),
          y * factor + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y};
}

}  // namespace dxslam
