// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <Eigen/Core>

#include "core/camera.h"
#include "core/frame.h"
#include "core/se3.h"

namespace dxslam {

/// Points nearer to the image plane than this many metres have no usable projection.
constexpr double kMinProjectionDepth = 1e-3;

/// Where a point in the camera frame appears, (u, v, u - disparity) in undistorted pixels. The
/// third row is the column of the point in a virtual right image, see Camera::bf.
inline Eigen::Vector3d project_stereo(const Camera& camera, const Eigen::Vector3d& p) {
  const double inverse_z = 1.0 / p.z();
  const double u = camera.fx * p.x() * inverse_z + camera.cx;
  return {u, camera.fy * p.y() * inverse_z + camera.cy, u - camera.bf() * inverse_z};
}

/// project_stereo minus what was measured, pixels; the last is 0 without a disparity.
inline Eigen::Vector3d stereo_residual(const Camera& camera, const Measurement& m,
                                       const Eigen::Vector3d& p) {
  const Eigen::Vector3d measured(m.pixel.x(), m.pixel.y(), m.pixel.x() - m.disparity);
  Eigen::Vector3d r = project_stereo(camera, p) - measured;
  if (!m.has_disparity()) r.z() = 0.0;
  return r;
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

/// What one observation says about its point in the camera frame: weight * J^T J and weight * J^T r
/// for J = project_stereo_jacobian and a residual r in pixels. Without `depth` the third row of
/// both is left out. Spelt out, since J is half zeros and this is the hottest code of the
/// optimisers.
inline void point_information(const Camera& camera, const Eigen::Vector3d& p,
                              const Eigen::Vector3d& r, double weight, bool depth,
                              Eigen::Matrix3d& information, Eigen::Vector3d& pull) {
  const double inverse_z = 1.0 / p.z();
  const double a = camera.fx * inverse_z;                    // d u / d x
  const double b = -a * p.x() * inverse_z;                   // d u / d z
  const double c = camera.fy * inverse_z;                    // d v / d y
  const double d = -c * p.y() * inverse_z;                   // d v / d z
  const double e = b + camera.bf() * inverse_z * inverse_z;  // d (u - disparity) / d z
  const double third = depth ? weight : 0.0;
  const double wa = weight * a;
  const double wc = weight * c;
  information(0, 0) = (weight + third) * a * a;
  information(1, 0) = information(0, 1) = 0.0;
  information(1, 1) = wc * c;
  information(2, 0) = information(0, 2) = wa * b + third * a * e;
  information(2, 1) = information(1, 2) = wc * d;
  information(2, 2) = weight * (b * b + d * d) + third * e * e;
  pull(0) = wa * r(0) + third * a * r(2);
  pull(1) = wc * r(1);
  pull(2) = weight * (b * r(0) + d * r(1)) + third * e * r(2);
}

/// Adds to the normal equations of a left perturbation (rho, phi) what is known about the moved
/// point `p`: H += G^T information G and g += G^T pull for G = [I, -[p]]. Only the lower triangle
/// of the hessian is kept.
inline void add_left_perturbation(const Eigen::Matrix3d& information, const Eigen::Vector3d& pull,
                                  const Eigen::Vector3d& p, Matrix6d& hessian, Vector6d& gradient) {
  Eigen::Matrix3d moment;  // [p] information
  for (int k = 0; k < 3; ++k) moment.col(k) = p.cross(information.col(k));
  hessian.topLeftCorner<3, 3>() += information;
  hessian.bottomLeftCorner<3, 3>() += moment;
  // -[p] information [p], each row of which is p x the row of the moment.
  const Eigen::Vector3d m0 = moment.col(0);
  const Eigen::Vector3d m1 = moment.col(1);
  const Eigen::Vector3d m2 = moment.col(2);
  hessian.block<3, 1>(3, 3) += p.y() * m2 - p.z() * m1;
  hessian.block<3, 1>(3, 4) += p.z() * m0 - p.x() * m2;
  hessian.block<3, 1>(3, 5) += p.x() * m1 - p.y() * m0;
  gradient.head<3>() += pull;
  gradient.tail<3>() += p.cross(pull);
}

}  // namespace dxslam
