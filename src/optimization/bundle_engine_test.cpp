// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
//
// The solver of bundles against MINPACK and against dense normal equations by differences.
#include "optimization/bundle_engine.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <tuple>

#include "optimization/bundle_test_scene.h"
#include "optimization/huber.h"
#include "optimization/test_least_squares.h"

namespace dxslam {
namespace {

constexpr int kDense = 400;
constexpr int kSparse = 0;

long most_memory_kb() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

/// With and without the kernel, the poses solved for densely and sparsely.
class BundleEngineTest : public testing::TestWithParam<std::tuple<bool, int>> {
 protected:
  void prepare(const BundleSceneOptions& options) {
    scene_ = make_bundle_scene(options);
    options_.min_decrease = 1e-9;
    start_ = BundleState();
    stage_ = BundleStage();
    for (const BundleProblem::Pose& pose : scene_.problem.poses) {
      start_.camera_from_world.push_back(pose.world_from_camera.inverse());
      stage_.held.push_back(pose.fixed ? 1 : 0);
    }
    start_.points = scene_.problem.points;
    stage_.problem = &scene_.problem;
    stage_.options = &options_;
    stage_.active.assign(scene_.problem.observations.size(), 1);
    stage_.iterations = 100;
    stage_.robust = std::get<0>(GetParam());
    stage_.max_dense_poses = std::get<1>(GetParam());
    stage_.max_coupled_share = 1.0;
  }

  Eigen::Vector3d residual(const BundleState& state, std::size_t i) const {
    const BundleProblem::Observation& o = scene_.problem.observations[i];
    return bundle_residual(scene_.camera, o,
                           state.camera_from_world[static_cast<std::size_t>(o.pose)] *
                               state.points[static_cast<std::size_t>(o.point)]);
  }

  double gate2(std::size_t i) const {
    return bundle_gate2(scene_.problem.observations[i], options_);
  }

  /// Half the sum of what the solver minimises.
  double cost(const BundleState& state) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < stage_.active.size(); ++i) {
      if (stage_.active[i] == 0) continue;
      const Eigen::Vector3d r = residual(state, i);
      const double scale = stage_.robust ? huber_scale(r.squaredNorm(), gate2(i)) : 1.0;
      sum += (scale * r).squaredNorm();
    }
    return 0.5 * sum;
  }

  Eigen::Index free_poses() const { return std::count(stage_.held.begin(), stage_.held.end(), 0); }
  Eigen::Index unknowns() const {
    return 6 * free_poses() + 3 * static_cast<Eigen::Index>(start_.points.size());
  }
  Eigen::Index residuals() const { return 3 * static_cast<Eigen::Index>(stage_.active.size()); }

  /// The start moved by `delta`: free poses from the left, then points.
  BundleState moved(const Eigen::VectorXd& delta) const {
    BundleState state = start_;
    Eigen::Index next = 0;
    for (std::size_t i = 0; i < state.camera_from_world.size(); ++i) {
      if (stage_.held[i] != 0) continue;
      const Vector6d step = delta.segment<6>(next);
      state.camera_from_world[i] = SE3::exp(step) * state.camera_from_world[i];
      next += 6;
    }
    for (Eigen::Vector3d& point : state.points) {
      point += delta.segment<3>(next);
      next += 3;
    }
    return state;
  }

  double worst_pose_difference(const BundleState& a, const BundleState& b) const {
    double worst = 0.0;
    for (std::size_t i = 0; i < a.camera_from_world.size(); ++i) {
      const SE3 apart = a.camera_from_world[i] * b.camera_from_world[i].inverse();
      worst = std::max(worst, apart.log().norm());
    }
    return worst;
  }

  BundleScene scene_;
  BundleState start_;
  BundleStage stage_;
  BundleOptions options_;
};

TEST_P(BundleEngineTest, FindsTheMinimumThatMinpackFinds) {
  for (const std::uint32_t seed : {1U, 2U}) {
    BundleSceneOptions options;
    options.poses = 5;
    options.points = 40;
    options.seed = seed;
    prepare(options);
    options_.min_decrease = 0.0;
    options_.chi2_pixel = 1.0;  // so that the kernel works on many observations
    options_.chi2_depth = 1.5;
    BundleState own = start_;
    ASSERT_TRUE(minimise_bundle(stage_, own).usable);
    EXPECT_LT(cost(own), 0.7 * cost(start_));
    const auto weighted = [&](const Eigen::VectorXd& delta, Eigen::VectorXd& r) {
      const BundleState state = moved(delta);
      for (std::size_t i = 0; i < stage_.active.size(); ++i) {
        const Eigen::Vector3d part = residual(state, i);
        const double scale = stage_.robust ? huber_scale(part.squaredNorm(), gate2(i)) : 1.0;
        r.segment<3>(3 * static_cast<Eigen::Index>(i)) = scale * part;
      }
    };
    // MINPACK takes the kernel for a part of the residual and gets stuck far from the minimum; near
    // it, it shows whether there is anything better.
    if (stage_.robust) start_ = own;
    const BundleState expected = moved(minimise_by_minpack(unknowns(), residuals(), weighted));
    EXPECT_NEAR(cost(own), cost(expected), 1e-6 * cost(expected));
    // Under the kernel the weights change from step to step, which converges slowly.
    EXPECT_LT(worst_pose_difference(own, expected), stage_.robust ? 1e-3 : 1e-6);
  }
}

TEST_P(BundleEngineTest, TakesTheStepOfTheDenseNormalEquations) {
  BundleSceneOptions options;
  options.poses = 6;
  options.points = 60;
  options.outlier_share = std::get<0>(GetParam()) ? 0.05 : 0.0;
  prepare(options);
  stage_.iterations = 1;
  const auto plain = [&](const Eigen::VectorXd& delta, Eigen::VectorXd& r) {
    const BundleState state = moved(delta);
    for (std::size_t i = 0; i < stage_.active.size(); ++i) {
      r.segment<3>(3 * static_cast<Eigen::Index>(i)) = residual(state, i);
    }
  };
  const Eigen::MatrixXd jacobian = jacobian_by_differences(unknowns(), residuals(), plain);
  Eigen::VectorXd r(residuals());
  plain(Eigen::VectorXd::Zero(unknowns()), r);
  Eigen::VectorXd weights = Eigen::VectorXd::Ones(residuals());
  for (std::size_t i = 0; i < stage_.active.size() && stage_.robust; ++i) {
    double weight = 1.0;
    huber(residual(start_, i).squaredNorm(), gate2(i), weight);
    weights.segment<3>(3 * static_cast<Eigen::Index>(i)).setConstant(weight);
  }
  Eigen::MatrixXd hessian = jacobian.transpose() * weights.asDiagonal() * jacobian;
  hessian.diagonal() *= 1.0 + kInitialDamping;
  const Eigen::VectorXd gradient = jacobian.transpose() * (weights.asDiagonal() * r);
  const BundleState expected = moved(hessian.ldlt().solve(-gradient));

  BundleState own = start_;
  ASSERT_TRUE(minimise_bundle(stage_, own).usable);
  ASSERT_LT(cost(own), cost(start_));
  EXPECT_GT(worst_pose_difference(start_, expected), 1e-2);
  EXPECT_LT(worst_pose_difference(own, expected), 1e-7);
  for (std::size_t i = 0; i < own.points.size(); ++i) {
    EXPECT_LT((own.points[i] - expected.points[i]).norm(), 1e-6) << i;
  }
}

TEST_P(BundleEngineTest, StopsWhenTold) {
  prepare(BundleSceneOptions());
  stage_.may_go_on = [] { return false; };
  BundleState state = start_;
  EXPECT_TRUE(minimise_bundle(stage_, state).cancelled);
}

TEST_P(BundleEngineTest, KeepsHeldPosesAndUnseenPoints) {
  BundleSceneOptions options;
  options.poses = 6;
  options.points = 80;
  prepare(options);
  stage_.held[4] = 1;
  for (std::size_t i = 0; i < stage_.active.size(); ++i) {
    if (scene_.problem.observations[i].point == 7) stage_.active[i] = 0;
  }
  BundleState state = start_;
  ASSERT_TRUE(minimise_bundle(stage_, state).usable);
  EXPECT_EQ(state.camera_from_world[4].matrix(), start_.camera_from_world[4].matrix());
  EXPECT_NE(state.camera_from_world[5].matrix(), start_.camera_from_world[5].matrix());
  EXPECT_EQ(state.points[7], start_.points[7]);
}

TEST_P(BundleEngineTest, BearsPosesWithoutEnoughToHoldThem) {
  BundleSceneOptions options;
  options.poses = 5;
  options.points = 60;
  options.depth_share = 0.0;
  prepare(options);
  int left = 2;  // of the last pose; the points of most observations stay with a single one
  for (std::size_t i = 0; i < stage_.active.size(); ++i) {
    if (scene_.problem.observations[i].pose == 4 && left-- <= 0) stage_.active[i] = 0;
  }
  BundleState state = start_;
  ASSERT_TRUE(minimise_bundle(stage_, state).usable);
  EXPECT_LE(cost(state), cost(start_));
  EXPECT_TRUE(state.camera_from_world[4].matrix().allFinite());
}

TEST_P(BundleEngineTest, HandlesAPoseThatSeesAPointTwice) {
  BundleSceneOptions options;
  options.poses = 8;
  options.points = 150;
  options.pixel_noise = 0.0;
  prepare(options);
  for (std::size_t i = 0; i < 100; ++i) {
    scene_.problem.observations.push_back(scene_.problem.observations[3 * i]);
    stage_.active.push_back(1);
  }
  BundleState state = start_;
  ASSERT_TRUE(minimise_bundle(stage_, state).usable);
  EXPECT_LT(cost(state), 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Kernel, BundleEngineTest,
                         testing::Combine(testing::Bool(), testing::Values(kDense, kSparse)));

// As the whole map of a day: a table of all pairs of poses would take 800 MB.
TEST(BundleEngine, BoundsItsMemoryForManyPoses) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers keep a multiple of the memory";
#endif
  constexpr int kPoses = 20000;
  const Camera camera = test_camera();
  BundleProblem problem;
  problem.rig = Rig(camera);
  problem.poses.resize(kPoses);
  BundleState state;
  for (int i = 0; i < kPoses; ++i) {
    const Eigen::Vector3d position(0.1 * i, 0.0, 0.0);
    state.camera_from_world.emplace_back(Eigen::Quaterniond::Identity(), -position);
    for (const double y : {-0.2, 0.3}) {
      const Eigen::Vector3d point = position + Eigen::Vector3d(0.0, y, 2.0);
      for (int pose = std::max(0, i - 2); pose <= i; ++pose) {
        BundleProblem::Observation o;
        o.pose = pose;
        o.point = static_cast<int>(state.points.size());
        o.measured.pixel =
            camera.project(state.camera_from_world[static_cast<std::size_t>(pose)] * point);
        o.measured.disparity = camera.bf() / 2.0;
        problem.observations.push_back(o);
      }
      state.points.emplace_back(point + Eigen::Vector3d(0.01, 0.0, 0.0));
    }
  }
  BundleOptions options;
  BundleStage stage;
  stage.problem = &problem;
  stage.options = &options;
  stage.active.assign(problem.observations.size(), 1);
  stage.held.assign(kPoses, 0);
  stage.held[0] = 1;
  stage.iterations = 1;
  const long before = most_memory_kb();
  EXPECT_TRUE(minimise_bundle(stage, state).usable);
  EXPECT_LT(most_memory_kb() - before, 500000);
}

TEST(BundleResidual, IsTheProjectionMinusTheMeasurement) {
  const BundleScene scene = make_bundle_scene(BundleSceneOptions());
  for (std::size_t i = 0; i < 60; ++i) {
    BundleProblem::Observation o = scene.problem.observations[i];
    o.measured.sigma = 0.7;
    const Eigen::Vector3d p =
        scene.true_world_from_camera[static_cast<std::size_t>(o.pose)].inverse() *
        scene.true_points[static_cast<std::size_t>(o.point)];
    const Camera& c = scene.camera;
    const double u = c.fx * p.x() / p.z() + c.cx;
    const double v = c.fy * p.y() / p.z() + c.cy;
    const double disparity = o.measured.has_disparity() ? c.bf() / p.z() - o.measured.disparity
                                                        : u - o.measured.pixel.x();
    const Eigen::Vector3d expected(u - o.measured.pixel.x(), v - o.measured.pixel.y(),
                                   u - o.measured.pixel.x() - disparity);
    EXPECT_LT((bundle_residual(c, o, p) - expected / o.measured.sigma).norm(), 1e-10);
  }
}

TEST(BundleResidual, IsFiniteBehindTheCamera) {
  const BundleScene scene = make_bundle_scene(BundleSceneOptions());
  const BundleProblem::Observation& o = scene.problem.observations[0];
  for (const double z : {0.0, -1.0, std::nan("")}) {
    EXPECT_TRUE(bundle_residual(scene.camera, o, {0.1, 0.2, z}).allFinite());
  }
}

}  // namespace
}  // namespace dxslam
