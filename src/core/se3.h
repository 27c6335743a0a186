// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace dxslam {

// Transforms are named by frames: x_in_a = a_from_b * x_in_b. The camera frame is x right, y down,
// z forward. Tangent vectors are (rho, phi): translation first, then rotation, in metres and
// radians; perturbations act on the left, exp(delta) * T, unless a comment says otherwise.

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Vector7d = Eigen::Matrix<double, 7, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Matrix7d = Eigen::Matrix<double, 7, 7>;

/// Skew-symmetric matrix: skew(v) * w = v x w.
Eigen::Matrix3d skew(const Eigen::Vector3d& v);

/// Rotation vector to unit quaternion and back; stable near zero and near pi.
Eigen::Quaterniond so3_exp(const Eigen::Vector3d& phi);
Eigen::Vector3d so3_log(const Eigen::Quaterniond& q);
/// so3_exp(phi + d) ~ so3_exp(so3_left_jacobian(phi) * d) * so3_exp(phi).
Eigen::Matrix3d so3_left_jacobian(const Eigen::Vector3d& phi);

/// Rigid motion. Invariant: the quaternion is of unit length.
class SE3 {
 public:
  SE3() = default;
  SE3(const Eigen::Quaterniond& rotation, const Eigen::Vector3d& translation)
      : rotation_(rotation.normalized()), translation_(translation) {}
  SE3(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& translation)
      : SE3(Eigen::Quaterniond(rotation), translation) {}
  /// From a 4x4 matrix whose rotation block is orthonormal up to rounding.
  explicit SE3(const Eigen::Matrix4d& matrix);

  /// Takes a quaternion that is of unit length already to the bit: what was stored comes back.
  static SE3 of_unit(const Eigen::Quaterniond& rotation, const Eigen::Vector3d& translation) {
    SE3 pose;
    pose.rotation_ = rotation;
    pose.translation_ = translation;
    return pose;
  }

  static SE3 exp(const Vector6d& tangent);
  Vector6d log() const;
  /// exp(Adj * v) = T * exp(v) * T^-1.
  Matrix6d adjoint() const;
  Eigen::Matrix4d matrix() const;
  SE3 inverse() const;

  SE3 operator*(const SE3& other) const {
    return {rotation_ * other.rotation_, rotation_ * other.translation_ + translation_};
  }
  Eigen::Vector3d operator*(const Eigen::Vector3d& point) const {
    return rotation_ * point + translation_;
  }

  const Eigen::Quaterniond& rotation() const { return rotation_; }
  const Eigen::Vector3d& translation() const { return translation_; }

 private:
  Eigen::Quaterniond rotation_ = Eigen::Quaterniond::Identity();
  Eigen::Vector3d translation_ = Eigen::Vector3d::Zero();
};

/// Angle of the rotation between two poses, radians, in [0, pi].
double rotation_angle(const SE3& a, const SE3& b);
/// Distance of the origins of two poses given as world_from_camera, metres.
double translation_distance(const SE3& a, const SE3& b);

}  // namespace dxslam
