// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/recordings/inverse_distortion.h"

#include <Eigen/Dense>
#include <algorithm>
#include <vector>

namespace dxslam {
namespace {

constexpr int kParts = 32;  // of each side of the image

// What each coefficient moves a point of the plane at depth 1 by.
Eigen::Matrix<double, 2, 5> shifts_at(const Eigen::Vector2d& point) {
  const double x = point.x();
  const double y = point.y();
  const double r2 = point.squaredNorm();
  Eigen::Matrix<double, 2, 5> shifts;
  shifts.row(0) << x * r2, x * r2 * r2, 2.0 * x * y, r2 + 2.0 * x * x, x * r2 * r2 * r2;
  shifts.row(1) << y * r2, y * r2 * r2, r2 + 2.0 * y * y, 2.0 * x * y, y * r2 * r2 * r2;
  return shifts;
}

}  // namespace

double set_inverse_distortion(const std::array<double, 5>& inverse, Camera& camera) {
  const Eigen::Map<const Eigen::Matrix<double, 5, 1>> undistortion(inverse.data());
  constexpr int kSamples = (kParts + 1) * (kParts + 1);
  Eigen::Matrix<double, Eigen::Dynamic, 5> shifts(2 * kSamples, 5);
  Eigen::VectorXd moved(2 * kSamples);
  int sample = 0;
  for (int row = 0; row <= kParts; ++row) {
    for (int column = 0; column <= kParts; ++column, ++sample) {
      const Eigen::Vector2d raw(((camera.width - 1.0) * column / kParts - camera.cx) / camera.fx,
                                ((camera.height - 1.0) * row / kParts - camera.cy) / camera.fy);
      const Eigen::Vector2d ideal = raw + shifts_at(raw) * undistortion;
      shifts.middleRows<2>(2 * sample) = shifts_at(ideal);
      moved.segment<2>(2 * sample) = raw - ideal;
    }
  }
  const Eigen::Matrix<double, 5, 1> fitted = shifts.colPivHouseholderQr().solve(moved);
  camera.lens = Lens();
  std::copy(fitted.begin(), fitted.end(), camera.lens.parameters.begin());
  return (shifts * fitted - moved).cwiseAbs().maxCoeff() * std::max(camera.fx, camera.fy);
}

}  // namespace dxslam
