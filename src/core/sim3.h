// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include "core/se3.h"

namespace dxslam {

/// Similarity transform: x -> scale * R * x + t. Tangent is (rho, phi, sigma), sigma = log scale.
class Sim3 {
 public:
  Sim3() = default;
  Sim3(double scale, const Eigen::Quaterniond& rotation, const Eigen::Vector3d& translation)
      : scale_(scale), rotation_(rotation.normalized()), translation_(translation) {}
  explicit Sim3(const SE3& rigid) : Sim3(1.0, rigid.rotation(), rigid.translation()) {}

  static Sim3 exp(const Vector7d& tangent);
  Vector7d log() const;
  /// exp(Adj * v) = T * exp(v) * T^-1.
  Matrix7d adjoint() const;
  Eigen::Matrix4d matrix() const;
  Sim3 inverse() const;

  Sim3 operator*(const Sim3& other) const {
    return {scale_ * other.scale_, rotation_ * other.rotation_,
            scale_ * (rotation_ * other.translation_) + translation_};
  }
  Eigen::Vector3d operator*(const Eigen::Vector3d& point) const {
    return scale_ * (rotation_ * point) + translation_;
  }

  double scale() const { return scale_; }
  const Eigen::Quaterniond& rotation() const { return rotation_; }
  const Eigen::Vector3d& translation() const { return translation_; }
  /// The rigid part: the same rotation and translation, scale dropped.
  SE3 rigid() const { return {rotation_, translation_}; }

 private:
  double scale_ = 1.0;
  Eigen::Quaterniond rotation_ = Eigen::Quaterniond::Identity();
  Eigen::Vector3d translation_ = Eigen::Vector3d::Zero();
};

/// ad(v) * w = [v, w]: the derivative of exp(t v).adjoint() * w by t at zero.
Matrix7d sim3_small_adjoint(const Vector7d& v);
/// (exp(v) * exp(d)).log() ~ v + sim3_right_jacobian_inverse(v) * d. By the Bernoulli series to
/// tenth order: exact to 1e-9 for rotations below 0.5 rad, to 0.1 % at pi.
Matrix7d sim3_right_jacobian_inverse(const Vector7d& v);

}  // namespace dxslam
