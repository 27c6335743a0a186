// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "geometry/reprojection.h"

#include <gtest/gtest.h>

#include <unsupported/Eigen/AutoDiff>

#include "geometry/geometry_scene.h"

namespace dxslam {
namespace {

using Jet = Eigen::AutoDiffScalar<Vector6d>;

/// The k-th of six variables.
Jet variable(double value, int k) { return {value, 6, k}; }

/// The same projection again, written for any scalar.
template <class T>
Eigen::Matrix<T, 3, 1> project(const Camera& c, const Eigen::Matrix<T, 3, 1>& p) {
  const T u = c.fx * p.x() / p.z() + c.cx;
  return {u, c.fy * p.y() / p.z() + c.cy, u - c.bf() / p.z()};
}

class ReprojectionTest : public testing::Test {
 protected:
  Eigen::Vector3d sample() {
    return camera_.unproject(random_pixel(source_), source_.uniform(0.2, 8.0));
  }
  Camera camera_ = test_camera();
  SampleSource source_{1};
};

TEST_F(ReprojectionTest, ProjectsLikeTheCamera) {
  for (int i = 0; i < 20; ++i) {
    const Eigen::Vector3d p = sample();
    const Eigen::Vector3d pixel = project_stereo(camera_, p);
    EXPECT_LT((pixel.head<2>() - camera_.project(p)).norm(), 1e-12);
    EXPECT_NEAR(pixel.x() - pixel.z(), camera_.bf() / p.z(), 1e-10);
  }
}

TEST_F(ReprojectionTest, DerivativeByThePointMatchesAutomaticDifferentiation) {
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector3d p = sample();
    const Eigen::Matrix<Jet, 3, 1> jet(variable(p.x(), 0), variable(p.y(), 1), variable(p.z(), 2));
    const Eigen::Matrix<Jet, 3, 1> result = project(camera_, jet);
    Eigen::Matrix3d expected;
    for (int r = 0; r < 3; ++r) expected.row(r) = result(r).derivatives().head<3>();
    EXPECT_LT((project_stereo_jacobian(camera_, p) - expected).norm(), 1e-10 * expected.norm());
  }
}

TEST_F(ReprojectionTest, DerivativeByThePoseMatchesAutomaticDifferentiation) {
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector3d p = sample();
    // exp(delta) p to first order, which is all that a derivative at zero sees.
    const Eigen::Matrix<Jet, 3, 1> rho(variable(0.0, 0), variable(0.0, 1), variable(0.0, 2));
    const Eigen::Matrix<Jet, 3, 1> phi(variable(0.0, 3), variable(0.0, 4), variable(0.0, 5));
    const Eigen::Matrix<Jet, 3, 1> fixed = p.cast<Jet>();
    const Eigen::Matrix<Jet, 3, 1> moved = fixed + phi.cross(fixed) + rho;
    const Eigen::Matrix<Jet, 3, 1> result = project(camera_, moved);
    Eigen::Matrix<double, 3, 6> expected;
    for (int r = 0; r < 3; ++r) expected.row(r) = result(r).derivatives();
    const Eigen::Matrix<double, 3, 6> jacobian =
        left_perturbation_jacobian<3>(project_stereo_jacobian(camera_, p), p);
    EXPECT_LT((jacobian - expected).norm(), 1e-10 * expected.norm());
  }
}

TEST_F(ReprojectionTest, DerivativeByThePoseMatchesNumericDifferences) {
  constexpr double kStep = 1e-6;
  for (const SE3& pose : sample_poses()) {
    const Eigen::Vector3d p = sample();
    const Eigen::Vector3d x = pose.inverse() * p;
    Eigen::Matrix<double, 3, 6> numeric;
    for (int k = 0; k < 6; ++k) {
      const Vector6d d = kStep * Vector6d::Unit(k);
      numeric.col(k) = (project_stereo(camera_, SE3::exp(d) * pose * x) -
                        project_stereo(camera_, SE3::exp(-d) * pose * x)) /
                       (2.0 * kStep);
    }
    const Eigen::Matrix<double, 3, 6> jacobian =
        left_perturbation_jacobian<3>(project_stereo_jacobian(camera_, p), p);
    EXPECT_LT((jacobian - numeric).norm(), 1e-6 * numeric.norm());
  }
}

TEST_F(ReprojectionTest, NormalEquationsAreThoseOfTheJacobians) {
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector3d p = sample();
    const Eigen::Vector3d r = source_.vector(3.0);
    const double weight = source_.uniform(0.1, 2.0);
    for (const bool depth : {false, true}) {
      const int rows = depth ? 3 : 2;
      const Eigen::Matrix3d j = project_stereo_jacobian(camera_, p);
      const Eigen::MatrixXd by_point = j.topRows(rows);
      const Eigen::MatrixXd by_pose = left_perturbation_jacobian<3>(j, p).topRows(rows);
      Eigen::Matrix3d information;
      Eigen::Vector3d pull;
      point_information(camera_, p, r, weight, depth, information, pull);
      const Eigen::Matrix3d expected = weight * by_point.transpose() * by_point;
      EXPECT_LT((information - expected).norm(), 1e-12 * expected.norm());
      EXPECT_LT((pull - weight * by_point.transpose() * r.head(rows)).norm(), 1e-9);

      Matrix6d hessian = Matrix6d::Zero();
      Vector6d gradient = Vector6d::Zero();
      add_left_perturbation(information, pull, p, hessian, gradient);
      const Matrix6d lower = hessian.selfadjointView<Eigen::Lower>();
      const Matrix6d full = weight * by_pose.transpose() * by_pose;
      EXPECT_LT((lower - full).norm(), 1e-12 * full.norm());
      EXPECT_LT((gradient - weight * by_pose.transpose() * r.head(rows)).norm(), 1e-9);
    }
  }
}

}  // namespace
}  // namespace dxslam
