// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "core/se3.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "core/transform_samples.h"

namespace dxslam {
namespace {

void expect_near(const SE3& a, const SE3& b, double tolerance) {
  const double difference = (a.matrix() - b.matrix()).cwiseAbs().maxCoeff();
  EXPECT_TRUE(difference <= tolerance) << difference << "\n"
                                       << a.matrix() << "\n!=\n"
                                       << b.matrix();
}

TEST(So3, LogInvertsExpUpToPi) {
  for (const Eigen::Vector3d& phi : sample_rotation_vectors()) {
    EXPECT_LT((so3_log(so3_exp(phi)) - phi).norm(), 1e-12 + 1e-7 * (phi.norm() > 3.1 ? 1 : 0));
  }
}

TEST(So3, ExpIsTheRotationAboutTheAxis) {
  for (const Eigen::Vector3d& phi : sample_rotation_vectors()) {
    const Eigen::Vector3d axis = phi.norm() > 0.0 ? phi.normalized() : Eigen::Vector3d::UnitX();
    const Eigen::Matrix3d expected = Eigen::AngleAxisd(phi.norm(), axis).toRotationMatrix();
    EXPECT_LT((so3_exp(phi).toRotationMatrix() - expected).norm(), 1e-14);
  }
}

TEST(So3, LogTakesTheShorterWayForBothSignsOfTheQuaternion) {
  const Eigen::Quaterniond q = so3_exp({0.3, -0.2, 0.1});
  const Eigen::Quaterniond negated(-q.w(), -q.x(), -q.y(), -q.z());
  EXPECT_LT((so3_log(q) - so3_log(negated)).norm(), 1e-15);
  EXPECT_NEAR(so3_log(Eigen::Quaterniond(0.0, 1.0, 0.0, 0.0)).norm(), M_PI, 1e-15);
}

TEST(So3, LeftJacobianMatchesNumericDifferences) {
  constexpr double kStep = 1e-6;
  for (const Eigen::Vector3d& phi : sample_rotation_vectors()) {
    Eigen::Matrix3d numeric;
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d d = kStep * Eigen::Vector3d::Unit(k);
      const Eigen::Vector3d ahead = so3_log(so3_exp(phi + d) * so3_exp(phi).conjugate());
      const Eigen::Vector3d behind = so3_log(so3_exp(phi - d) * so3_exp(phi).conjugate());
      numeric.col(k) = (ahead - behind) / (2.0 * kStep);
    }
    EXPECT_LT((so3_left_jacobian(phi) - numeric).norm(), 1e-8) << phi.transpose();
  }
}

TEST(Se3, GroupLawsHold) {
  const std::vector<SE3> poses = sample_poses();
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const SE3& a = poses[i];
    const SE3& b = poses[(i + 7) % poses.size()];
    const SE3& c = poses[(i + 19) % poses.size()];
    expect_near((a * b) * c, a * (b * c), 1e-13);
    expect_near(a * a.inverse(), SE3(), 1e-14);
    expect_near(a.inverse() * a, SE3(), 1e-14);
    expect_near(a * SE3(), a, 1e-14);
    expect_near((a * b).inverse(), b.inverse() * a.inverse(), 1e-13);
    EXPECT_NEAR((a * b).rotation().norm(), 1.0, 1e-15);
  }
}

TEST(Se3, ActsOnPointsAsItsMatrix) {
  SampleSource source(1);
  for (const SE3& pose : sample_poses()) {
    const Eigen::Vector3d x = source.vector(3.0);
    const Eigen::Vector4d expected = pose.matrix() * x.homogeneous();
    EXPECT_LT((pose * x - expected.head<3>()).norm(), 1e-14);
    expect_near(SE3(pose.matrix()), pose, 1e-14);
  }
}

TEST(Se3, ExpInvertsLogEverywhere) {
  for (const SE3& pose : sample_poses()) expect_near(SE3::exp(pose.log()), pose, 1e-10);
}

TEST(Se3, LogInvertsExp) {
  SampleSource source(2);
  for (const Eigen::Vector3d& phi : sample_rotation_vectors()) {
    Vector6d v;
    v << source.vector(2.0), phi;
    EXPECT_LT((SE3::exp(v).log() - v).norm(), phi.norm() > 3.1 ? 1e-6 : 1e-10);
  }
}

TEST(Se3, ExpIsTheMatrixExponential) {
  for (const SE3& pose : sample_poses()) {
    const Vector6d v = pose.log();
    Eigen::Matrix4d m = Eigen::Matrix4d::Zero();
    m.topLeftCorner<3, 3>() = skew(v.tail<3>());
    m.topRightCorner<3, 1>() = v.head<3>();
    Eigen::Matrix4d sum = Eigen::Matrix4d::Identity();
    Eigen::Matrix4d term = Eigen::Matrix4d::Identity();
    for (int k = 1; k < 40; ++k) sum += term = term * m / k;
    EXPECT_LT((SE3::exp(v).matrix() - sum).norm(), 1e-10);
  }
}

TEST(Se3, AdjointMovesATangentAcross) {
  SampleSource source(3);
  for (const SE3& pose : sample_poses()) {
    const Vector6d v = source.tangent(0.5);
    expect_near(SE3::exp(pose.adjoint() * v), pose * SE3::exp(v) * pose.inverse(), 1e-12);
  }
}

TEST(Se3, MeasuresAnglesAndDistances) {
  const SE3 a(so3_exp({0.0, 0.0, 0.4}), {1.0, 2.0, 3.0});
  const SE3 b(so3_exp({0.0, 0.0, -0.3}), {1.0, 5.0, 7.0});
  EXPECT_NEAR(rotation_angle(a, b), 0.7, 1e-15);
  EXPECT_NEAR(rotation_angle(b, a), 0.7, 1e-15);
  EXPECT_DOUBLE_EQ(translation_distance(a, b), 5.0);
}

TEST(Se3, NormalisesTheQuaternionItIsGiven) {
  const SE3 pose(Eigen::Quaterniond(2.0, 0.0, 0.0, 2.0), Eigen::Vector3d::Zero());
  EXPECT_NEAR(pose.rotation().norm(), 1.0, 1e-15);
}

}  // namespace
}  // namespace dxslam
