// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "core/sim3.h"

#include <Eigen/LU>
#include <cmath>

namespace dxslam {
namespace {

// W(sigma, phi) = integral over u in [0, 1] of exp(u (sigma I + [phi])), which takes rho to the
// translation of exp. Written as c I + a [phi] + b [phi]^2.
Eigen::Matrix3d translation_jacobian(const Eigen::Vector3d& phi, double sigma) {
  const double theta = phi.norm();
  const Eigen::Matrix3d w = skew(phi);
  const double radius2 = sigma * sigma + theta * theta;
  if (radius2 < 1e-2) {
    // The closed form cancels here; sum of M^k / (k + 1)!, whose tenth term is below rounding.
    const Eigen::Matrix3d m = sigma * Eigen::Matrix3d::Identity() + w;
    Eigen::Matrix3d sum = Eigen::Matrix3d::Identity();
    Eigen::Matrix3d term = Eigen::Matrix3d::Identity();
    for (int k = 1; k <= 10; ++k) {
      term = term * m / (k + 1.0);
      sum += term;
    }
    return sum;
  }
  const double scale = std::exp(sigma);
  const double c = std::abs(sigma) > 0.0 ? std::expm1(sigma) / sigma : 1.0;
  if (!(theta > 0.0)) return c * Eigen::Matrix3d::Identity();
  const double sine = std::sin(theta);
  const double cosine = std::cos(theta);
  const double a = (scale * (sigma * sine / theta - cosine) + 1.0) / radius2;
  const double b =
      (c - (scale * (sigma * cosine + theta * sine) - sigma) / radius2) / (theta * theta);
  return c * Eigen::Matrix3d::Identity() + a * w + b * w * w;
}

}  // namespace

Sim3 Sim3::exp(const Vector7d& tangent) {
  const Eigen::Vector3d phi = tangent.segment<3>(3);
  const double sigma = tangent(6);
  return {std::exp(sigma), so3_exp(phi), translation_jacobian(phi, sigma) * tangent.head<3>()};
}

Vector7d Sim3::log() const {
  const Eigen::Vector3d phi = so3_log(rotation_);
  const double sigma = std::log(scale_);
  Vector7d tangent;
  tangent << translation_jacobian(phi, sigma).inverse() * translation_, phi, sigma;
  return tangent;
}

Matrix7d Sim3::adjoint() const {
  const Eigen::Matrix3d r = rotation_.toRotationMatrix();
  Matrix7d adjoint = Matrix7d::Zero();
  adjoint.topLeftCorner<3, 3>() = scale_ * r;
  adjoint.block<3, 3>(0, 3) = skew(translation_) * r;
  adjoint.block<3, 1>(0, 6) = -translation_;
  adjoint.block<3, 3>(3, 3) = r;
  adjoint(6, 6) = 1.0;
  return adjoint;
}

Eigen::Matrix4d Sim3::matrix() const {
  Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
  m.topLeftCorner<3, 3>() = scale_ * rotation_.toRotationMatrix();
  m.topRightCorner<3, 1>() = translation_;
  return m;
}

Sim3 Sim3::inverse() const {
  const Eigen::Quaterniond q = rotation_.conjugate();
  return {1.0 / scale_, q, -(q * translation_) / scale_};
}

Matrix7d sim3_small_adjoint(const Vector7d& v) {
  const Eigen::Matrix3d turn = skew(v.segment<3>(3));
  Matrix7d ad = Matrix7d::Zero();
  ad.topLeftCorner<3, 3>() = v(6) * Eigen::Matrix3d::Identity() + turn;
  ad.block<3, 3>(0, 3) = skew(v.head<3>());
  ad.block<3, 1>(0, 6) = -v.head<3>();
  ad.block<3, 3>(3, 3) = turn;
  return ad;
}

Matrix7d sim3_right_jacobian_inverse(const Vector7d& v) {
  // B_n / n! of the even Bernoulli numbers; of the odd ones only the first is not zero.
  constexpr double kCoefficients[] = {1.0 / 12.0, -1.0 / 720.0, 1.0 / 30240.0, -1.0 / 1209600.0,
                                      1.0 / 47900160.0};
  const Matrix7d ad = sim3_small_adjoint(v);
  const Matrix7d squared = ad * ad;
  Matrix7d power = squared;
  Matrix7d sum = Matrix7d::Identity() + 0.5 * ad;
  for (const double coefficient : kCoefficients) {
    sum += coefficient * power;
    power = power * squared;
  }
  return sum;
}

}  // namespace dxslam
