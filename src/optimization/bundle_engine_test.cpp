// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
//
// The own solver against Ceres, and what both are built on against automatic differentiation.
#include "optimization/bundle_engine.h"

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "optimization/bundle_test_scene.h"

namespace dxslam {
namespace {

using Jet = ceres::Jet<double, 3>;

class BundleEngineTest : public testing::TestWithParam<bool> {
 protected:
  void prepare(const BundleSceneOptions& options) {
    scene_ = make_bundle_scene(options);
    options_.min_decrease = 1e-9;
    for (const BundleProblem::Pose& pose : scene_.problem.poses) {
      start_.camera_from_world.push_back(pose.world_from_camera.inverse());
      stage_.held.push_back(pose.fixed ? 1 : 0);
    }
    start_.points = scene_.problem.points;
    stage_.camera = &scene_.camera;
    stage_.problem = &scene_.problem;
    stage_.options = &options_;
    stage_.active.assign(scene_.problem.observations.size(), 1);
    stage_.iterations = 100;
    stage_.robust = GetParam();
  }

  /// Half the sum of what the solvers minimise.
  double cost(const BundleState& state) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < stage_.active.size(); ++i) {
      if (stage_.active[i] == 0) continue;
      const BundleProblem::Observation& o = scene_.problem.observations[i];
      const double error2 =
          bundle_residual(scene_.camera, o,
                          state.camera_from_world[static_cast<std::size_t>(o.pose)] *
                              state.points[static_cast<std::size_t>(o.point)])
              .squaredNorm();
      const double gate2 = bundle_gate2(o, options_);
      sum += !stage_.robust || error2 <= gate2 ? error2 : 2.0 * std::sqrt(gate2 * error2) - gate2;
    }
    return 0.5 * sum;
  }

  BundleScene scene_;
  BundleState start_;
  BundleStage stage_;
  BundleOptions options_;
};

TEST_P(BundleEngineTest, OwnSolverFindsTheMinimumThatCeresFinds) {
  for (const std::uint32_t seed : {1U, 2U, 3U}) {
    BundleSceneOptions options;
    options.poses = 9;
    options.points = 200;
    options.outlier_share = GetParam() ? 0.05 : 0.0;
    options.seed = seed;
    start_ = BundleState();
    stage_.held.clear();
    prepare(options);
    BundleState own = start_;
    BundleState ceres = start_;
    const BundleStageReport a = minimise_with_schur(stage_, own);
    const BundleStageReport b = minimise_with_ceres(stage_, ceres);
    ASSERT_TRUE(a.usable && b.usable);
    // Under the kernel both converge slowly and stop at a share of the cost.
    const double tolerance = GetParam() ? 1e-4 : 1e-7;
    EXPECT_NEAR(cost(own), cost(ceres), tolerance * cost(ceres));
    EXPECT_LT(cost(own), 0.7 * cost(start_));
    for (std::size_t i = 0; i < own.camera_from_world.size(); ++i) {
      const SE3 apart = own.camera_from_world[i] * ceres.camera_from_world[i].inverse();
      EXPECT_LT(apart.log().norm(), GetParam() ? 2e-3 : 1e-5);
    }
  }
}

TEST_P(BundleEngineTest, OwnSolverTakesTheStepsThatCeresTakes) {
  // From the same start, with the same damping, one step leads to nearly the same place; so
  // normal equations and elimination are right, not just the fixed point of the iteration. Under
  // the kernel Ceres adds a second-order term that ours leaves out.
  BundleSceneOptions options;
  options.poses = 9;
  options.points = 200;
  options.outlier_share = 0.0;
  prepare(options);
  stage_.iterations = 1;
  BundleState own = start_;
  BundleState ceres = start_;
  minimise_with_schur(stage_, own);
  minimise_with_ceres(stage_, ceres);
  EXPECT_LT(cost(own), cost(start_));
  for (std::size_t i = 0; i < own.camera_from_world.size(); ++i) {
    const double moved =
        (own.camera_from_world[i] * start_.camera_from_world[i].inverse()).log().norm();
    const double apart =
        (own.camera_from_world[i] * ceres.camera_from_world[i].inverse()).log().norm();
    EXPECT_LE(apart, 1e-12 + (stage_.robust ? 0.3 : 1e-3) * moved) << i;
  }
}

TEST_P(BundleEngineTest, BothSolversStopWhenTold) {
  prepare(BundleSceneOptions());
  stage_.may_go_on = [] { return false; };
  BundleState state = start_;
  EXPECT_TRUE(minimise_with_schur(stage_, state).cancelled);
  state = start_;
  EXPECT_TRUE(minimise_with_ceres(stage_, state).cancelled);
}

TEST_P(BundleEngineTest, BothSolversKeepHeldPosesAndUnseenPoints) {
  BundleSceneOptions options;
  options.poses = 6;
  options.points = 80;
  prepare(options);
  stage_.held[4] = 1;
  for (std::size_t i = 0; i < stage_.active.size(); ++i) {
    if (scene_.problem.observations[i].point == 7) stage_.active[i] = 0;
  }
  for (const auto& minimise : {minimise_with_schur, minimise_with_ceres}) {
    BundleState state = start_;
    ASSERT_TRUE(minimise(stage_, state).usable);
    EXPECT_EQ(state.camera_from_world[4].matrix(), start_.camera_from_world[4].matrix());
    EXPECT_NE(state.camera_from_world[5].matrix(), start_.camera_from_world[5].matrix());
    EXPECT_EQ(state.points[7], start_.points[7]);
  }
}

TEST_P(BundleEngineTest, BothSolversBearPosesWithoutEnoughToHoldThem) {
  BundleSceneOptions options;
  options.poses = 5;
  options.points = 60;
  options.depth_share = 0.0;
  prepare(options);
  int left = 2;  // of the last pose; the points of most observations stay with a single one
  for (std::size_t i = 0; i < stage_.active.size(); ++i) {
    if (scene_.problem.observations[i].pose == 4 && left-- <= 0) stage_.active[i] = 0;
  }
  for (const auto& minimise : {minimise_with_schur, minimise_with_ceres}) {
    BundleState state = start_;
    ASSERT_TRUE(minimise(stage_, state).usable);
    EXPECT_LE(cost(state), cost(start_));
    EXPECT_TRUE(state.camera_from_world[4].matrix().allFinite());
  }
}

INSTANTIATE_TEST_SUITE_P(Kernel, BundleEngineTest, testing::Bool());

TEST(BundleResidual, DerivativeMatchesAutomaticDifferentiation) {
  const BundleScene scene = make_bundle_scene(BundleSceneOptions());
  for (std::size_t i = 0; i < 60; ++i) {
    BundleProblem::Observation o = scene.problem.observations[i];
    o.sigma = 0.7;
    const Eigen::Vector3d p =
        scene.true_world_from_camera[static_cast<std::size_t>(o.pose)].inverse() *
        scene.true_points[static_cast<std::size_t>(o.point)];
    const Jet x(p.x(), 0);
    const Jet y(p.y(), 1);
    const Jet z(p.z(), 2);
    const Camera& c = scene.camera;
    const Jet u = c.fx * x / z + c.cx;
    const Jet v = c.fy * y / z + c.cy;
    const Jet rows[3] = {(u - o.pixel.x()) / o.sigma, (v - o.pixel.y()) / o.sigma,
                         (u - c.bf() / z - o.pixel.x() + o.disparity) / o.sigma};
    const Eigen::Vector3d residual = bundle_residual(c, o, p);
    const Eigen::Matrix3d jacobian = bundle_jacobian(c, o, p);
    for (int r = 0; r < 3; ++r) {
      const bool used = r < 2 || has_depth(o);
      EXPECT_NEAR(residual(r), used ? rows[r].a : 0.0, 1e-10);
      const Eigen::Vector3d expected = used ? Eigen::Vector3d(rows[r].v) : Eigen::Vector3d::Zero();
      EXPECT_LT((jacobian.row(r).transpose() - expected).norm(), 1e-9);
    }
  }
}

TEST(BundleResidual, IsFiniteBehindTheCamera) {
  const BundleScene scene = make_bundle_scene(BundleSceneOptions());
  const BundleProblem::Observation& o = scene.problem.observations[0];
  for (const double z : {0.0, -1.0, std::nan("")}) {
    EXPECT_TRUE(bundle_residual(scene.camera, o, {0.1, 0.2, z}).allFinite());
    EXPECT_EQ(bundle_jacobian(scene.camera, o, {0.1, 0.2, z}).norm(), 0.0);
  }
}

}  // namespace
}  // namespace dxslam
