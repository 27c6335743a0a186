// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <Eigen/Core>

#include "core/camera.h"

namespace dxslam {

/// Points nearer to the image plane than this many metres have no usable projection.
constexpr double kMinProjectionDepth = 1e-3;

/// Where a point in the camera frame appears, (u, v, u - disparity) in undistorted pixels. The
/// third row is the column of the point in a virtual right image, depth_baseline metres away.
inline Eigen::Vector3d project_stereo(const Camera& camera, const Eigen::Vector3d& p) {
  const double inverse_z = 1.0 / p.z();
  const double u = camera.fx * p.x() * inverse_z + camera.cx;
  return {u, camera.fy * p.y() * inverse_z + camera.cy, u - camera.bf() * inverse_z};
}

/// Derivative of project_stereo by the point in the camera frame.
inline Eigen::Matrix3d project_stereo_jacobian(const Camera& camera, const Eigen::Vector3d& p) {
  const double inverse_z = 1.0 / p.z();
  const double fx_z = camera.fx * inverse_z;
  const double fy_z = camera.fy * inverse_z;
  const double du_dz = -fx_z * p.x() * inverse_z;
  Eigen::Matrix3d jacobian;
  jacobian << fx_z, 0.0, du_dz,              //
      0.0, fy_z, -fy_z * p.y() * inverse_z,  //
      fx_z, 0.0, du_dz + camera.bf() * inverse_z * inverse_z;
  return jacobian;
}

/// Derivative of exp(delta) * T applied to a point, by delta = (rho, phi) at zero, multiplied from
/// the left by `by_point`; `p` is the moved point T * x.
template <int Rows>
Eigen::Matrix<double, Rows, 6> left_perturbation_jacobian(
    const Eigen::Matrix<double, Rows, 3>& by_point, const Eigen::Vector3d& p) {
  Eigen::Matrix<double, Rows, 6> jacobian;
  jacobian.template leftCols<3>() = by_point;
  // by_point * -[p]: each row r becomes p x r.
  jacobian.col(3) = p.y() * by_point.col(2) - p.z() * by_point.col(1);
  jacobian.col(4) = p.z() * by_point.col(0) - p.x() * by_point.col(2);
  jacobian.col(5) = p.x() * by_point.col(1) - p.y() * by_point.col(0);
  return jacobian;
}

}  // namespace dxslam
