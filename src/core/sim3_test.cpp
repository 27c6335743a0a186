// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "core/sim3.h"

#include <gtest/gtest.h>

#include "core/transform_samples.h"

namespace dxslam {
namespace {

void expect_near(const Sim3& a, const Sim3& b, double tolerance) {
  const double difference = (a.matrix() - b.matrix()).cwiseAbs().maxCoeff();
  EXPECT_TRUE(difference <= tolerance) << a.matrix() << "\n!=\n" << b.matrix();
}

Vector7d tangent(SampleSource& source, double extent) {
  Vector7d v;
  v << source.tangent(extent), source.uniform(-extent, extent);
  return v;
}

TEST(Sim3, GroupLawsHold) {
  const std::vector<Sim3> samples = sample_similarities();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Sim3& a = samples[i];
    const Sim3& b = samples[(i + 7) % samples.size()];
    const Sim3& c = samples[(i + 19) % samples.size()];
    expect_near((a * b) * c, a * (b * c), 1e-12);
    expect_near(a * a.inverse(), Sim3(), 1e-14);
    expect_near(a.inverse() * a, Sim3(), 1e-14);
    expect_near((a * b).inverse(), b.inverse() * a.inverse(), 1e-12);
  }
}

TEST(Sim3, ActsOnPointsAsItsMatrix) {
  SampleSource source(1);
  for (const Sim3& s : sample_similarities()) {
    const Eigen::Vector3d x = source.vector(3.0);
    const Eigen::Vector4d expected = s.matrix() * x.homogeneous();
    EXPECT_LT((s * x - expected.head<3>()).norm(), 1e-13);
  }
}

TEST(Sim3, ExpInvertsLogEverywhere) {
  for (const Sim3& s : sample_similarities()) expect_near(Sim3::exp(s.log()), s, 1e-10);
}

TEST(Sim3, ExpIsTheMatrixExponential) {
  // Scales on both sides of the switch to a series, alone and with rotation.
  SampleSource source(2);
  for (const double sigma : {0.0, 1e-9, 1e-4, 0.06, 0.0999, 0.1001, -0.5, 2.0}) {
    for (const Eigen::Vector3d& phi : sample_rotation_vectors()) {
      Vector7d v;
      v << source.vector(1.0), phi, sigma;
      Eigen::Matrix4d m = Eigen::Matrix4d::Zero();
      m.topLeftCorner<3, 3>() = sigma * Eigen::Matrix3d::Identity() + skew(phi);
      m.topRightCorner<3, 1>() = v.head<3>();
      Eigen::Matrix4d sum = Eigen::Matrix4d::Identity();
      Eigen::Matrix4d term = Eigen::Matrix4d::Identity();
      for (int k = 1; k < 60; ++k) sum += term = term * m / k;
      EXPECT_LT((Sim3::exp(v).matrix() - sum).norm(), 1e-11) << sigma << " " << phi.transpose();
    }
  }
}

TEST(Sim3, LogInvertsExp) {
  SampleSource source(3);
  for (int i = 0; i < 50; ++i) {
    const Vector7d v = tangent(source, 1.0);
    EXPECT_LT((Sim3::exp(v).log() - v).norm(), 1e-12);
  }
}

TEST(Sim3, AdjointMovesATangentAcross) {
  SampleSource source(4);
  for (const Sim3& s : sample_similarities()) {
    const Vector7d v = tangent(source, 0.3);
    expect_near(Sim3::exp(s.adjoint() * v), s * Sim3::exp(v) * s.inverse(), 1e-11);
  }
}

TEST(Sim3, AgreesWithSe3AtUnitScale) {
  for (const SE3& pose : sample_poses()) {
    const Sim3 s(pose);
    EXPECT_LT((s.matrix() - pose.matrix()).norm(), 1e-14);
    Vector7d expected;
    expected << pose.log(), 0.0;
    EXPECT_LT((s.log() - expected).norm(), 1e-9);
    EXPECT_LT((s.rigid().matrix() - pose.matrix()).norm(), 1e-14);
  }
}

TEST(Sim3, SmallAdjointIsTheDerivativeOfTheAdjoint) {
  SampleSource source(5);
  for (int i = 0; i < 10; ++i) {
    const Vector7d v = tangent(source, 1.0);
    const Matrix7d numeric =
        (Sim3::exp(1e-6 * v).adjoint() - Sim3::exp(-1e-6 * v).adjoint()) / 2e-6;
    EXPECT_LT((sim3_small_adjoint(v) - numeric).norm(), 1e-8);
  }
}

TEST(Sim3, RightJacobianInverseMatchesNumericDifferences) {
  SampleSource source(6);
  for (const double angle : {0.0, 1e-8, 0.1, 0.5, 1.5, 3.0}) {
    for (int i = 0; i < 5; ++i) {
      Vector7d v;
      v << source.vector(1.0), source.direction(angle), source.uniform(-0.3, 0.3);
      Matrix7d numeric;
      for (int k = 0; k < 7; ++k) {
        const Vector7d d = 1e-6 * Vector7d::Unit(k);
        numeric.col(k) =
            ((Sim3::exp(v) * Sim3::exp(d)).log() - (Sim3::exp(v) * Sim3::exp(-d)).log()) / 2e-6;
      }
      EXPECT_LT((sim3_right_jacobian_inverse(v) - numeric).norm(), angle < 1.0 ? 1e-8 : 5e-3);
    }
  }
}

}  // namespace
}  // namespace dxslam
