// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "core/se3.h"

#include <cmath>

namespace dxslam {
namespace {

constexpr double kSmallAngle = 1e-4;  // below it a Taylor series is exact to rounding

// Coefficients of the left Jacobian, J = I + a [phi] + b [phi]^2.
void left_jacobian_coefficients(double theta, double& a, double& b) {
  const double t2 = theta * theta;
  if (theta < kSmallAngle) {
    a = 0.5 - t2 / 24.0;
    b = 1.0 / 6.0 - t2 / 120.0;
  } else {
    a = (1.0 - std::cos(theta)) / t2;
    b = (theta - std::sin(theta)) / (t2 * theta);
  }
}

Eigen::Matrix3d so3_left_jacobian_inverse(const Eigen::Vector3d& phi) {
  const double theta = phi.norm();
  const Eigen::Matrix3d w = skew(phi);
  double c = 1.0 / 12.0 + theta * theta / 720.0;
  if (theta >= 1e-3) {
    const double half = 0.5 * theta;
    c = (1.0 - half / std::tan(half)) / (theta * theta);
  }
  return Eigen::Matrix3d::Identity() - 0.5 * w + c * w * w;
}

}  // namespace

Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

Eigen::Quaterniond so3_exp(const Eigen::Vector3d& phi) {
  const double theta = phi.norm();
  const double half = 0.5 * theta;
  const double scale = theta < kSmallAngle ? 0.5 - theta * theta / 48.0 : std::sin(half) / theta;
  Eigen::Quaterniond q;
  q.w() = std::cos(half);
  q.vec() = scale * phi;
  return q.normalized();
}

Eigen::Vector3d so3_log(const Eigen::Quaterniond& q) {
  const double sign = q.w() < 0.0 ? -1.0 : 1.0;  // the shorter of the two rotations
  const double sine = q.vec().norm();
  if (sine < 1e-9) return 2.0 * sign * q.vec();
  return sign * 2.0 * std::atan2(sine, sign * q.w()) / sine * q.vec();
}

Eigen::Matrix3d so3_left_jacobian(const Eigen::Vector3d& phi) {
  double a = 0.0;
  double b = 0.0;
  left_jacobian_coefficients(phi.norm(), a, b);
  const Eigen::Matrix3d w = skew(phi);
  return Eigen::Matrix3d::Identity() + a * w + b * w * w;
}

SE3::SE3(const Eigen::Matrix4d& matrix)
    : SE3(Eigen::Matrix3d(matrix.topLeftCorner<3, 3>()), matrix.topRightCorner<3, 1>()) {}

SE3 SE3::exp(const Vector6d& tangent) {
  const Eigen::Vector3d phi = tangent.tail<3>();
  return {so3_exp(phi), so3_left_jacobian(phi) * tangent.head<3>()};
}

Vector6d SE3::log() const {
  const Eigen::Vector3d phi = so3_log(rotation_);
  Vector6d tangent;
  tangent << so3_left_jacobian_inverse(phi) * translation_, phi;
  return tangent;
}

Matrix6d SE3::adjoint() const {
  const Eigen::Matrix3d r = rotation_.toRotationMatrix();
  Matrix6d adjoint = Matrix6d::Zero();
  adjoint.topLeftCorner<3, 3>() = r;
  adjoint.topRightCorner<3, 3>() = skew(translation_) * r;
  adjoint.bottomRightCorner<3, 3>() = r;
  return adjoint;
}

Eigen::Matrix4d SE3::matrix() const {
  Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
  m.topLeftCorner<3, 3>() = rotation_.toRotationMatrix();
  m.topRightCorner<3, 1>() = translation_;
  return m;
}

SE3 SE3::inverse() const {
  const Eigen::Quaterniond q = rotation_.conjugate();
  return {q, -(q * translation_)};
}

double rotation_angle(const SE3& a, const SE3& b) {
  return so3_log(a.rotation().conjugate() * b.rotation()).norm();
}

double translation_distance(const SE3& a, const SE3& b) {
  return (a.translation() - b.translation()).norm();
}

}  // namespace dxslam
