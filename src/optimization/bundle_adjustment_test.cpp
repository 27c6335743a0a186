// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "optimization/bundle_adjustment.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/options.h"
#include "optimization/bundle_test_scene.h"

namespace dxslam {
namespace {

BundleSceneOptions small() {
  BundleSceneOptions options;
  options.poses = 8;
  options.points = 150;
  return options;
}

double worst_pose_error(const BundleScene& scene, const BundleProblem& problem) {
  double worst = 0.0;
  for (std::size_t i = 0; i < problem.poses.size(); ++i) {
    worst = std::max(worst, translation_distance(problem.poses[i].world_from_camera,
                                                 scene.true_world_from_camera[i]));
  }
  return worst;
}

double worst_point_error(const BundleScene& scene, const BundleProblem& problem) {
  double worst = 0.0;
  for (std::size_t i = 0; i < problem.points.size(); ++i) {
    worst = std::max(worst, (problem.points[i] - scene.true_points[i]).norm());
  }
  return worst;
}

void expect_same(const BundleProblem& a, const BundleProblem& b) {
  for (std::size_t i = 0; i < a.poses.size(); ++i) {
    EXPECT_EQ(a.poses[i].world_from_camera.matrix(), b.poses[i].world_from_camera.matrix());
  }
  for (std::size_t i = 0; i < a.points.size(); ++i) EXPECT_EQ(a.points[i], b.points[i]);
}

BundleOptions patient() {
  BundleOptions options;
  options.iterations = options.refine_iterations = 50;
  return options;
}

TEST(BundleAdjustment, RecoversAnExactScene) {
  BundleSceneOptions options = small();
  options.pixel_noise = 0.0;
  const BundleScene scene = make_bundle_scene(options);
  BundleProblem problem = scene.problem;
  const BundleReport report = adjust_bundle(problem, patient());
  ASSERT_TRUE(report.usable);
  EXPECT_FALSE(report.cancelled);
  EXPECT_LT(report.final_cost, 1e-6);
  EXPECT_GT(worst_pose_error(scene, scene.problem), 0.02);
  EXPECT_LT(worst_pose_error(scene, problem), 1e-5);
  EXPECT_LT(worst_point_error(scene, problem), 1e-4);
  EXPECT_TRUE(
      std::all_of(report.inlier.begin(), report.inlier.end(), [](char c) { return c != 0; }));
}

TEST(BundleAdjustment, ImprovesANoisySceneInFewSteps) {
  const BundleScene scene = make_bundle_scene(BundleSceneOptions());
  BundleProblem problem = scene.problem;
  const BundleReport report = adjust_bundle(problem, BundleOptions());
  ASSERT_TRUE(report.usable);
  EXPECT_LE(report.iterations, 10);
  EXPECT_LT(report.final_cost, report.initial_cost);
  EXPECT_LT(worst_pose_error(scene, problem), 0.02);
  // Half the squared residuals is near half the degrees of freedom.
  const double observations = static_cast<double>(problem.observations.size());
  EXPECT_LT(report.final_cost, 0.5 * 2.7 * observations);
}

TEST(BundleAdjustment, TellsOutliersFromInliers) {
  BundleSceneOptions options;
  options.points = 600;
  options.outlier_share = 0.1;
  const BundleScene scene = make_bundle_scene(options);
  BundleProblem problem = scene.problem;
  const BundleReport report = adjust_bundle(problem, BundleOptions());
  ASSERT_TRUE(report.usable);
  int kept = 0;
  int lost = 0;
  int outliers = 0;
  for (std::size_t i = 0; i < scene.outlier.size(); ++i) {
    outliers += scene.outlier[i];
    if (scene.outlier[i] != 0 && report.inlier[i] != 0) ++kept;
    if (scene.outlier[i] == 0 && report.inlier[i] == 0) ++lost;
  }
  ASSERT_GT(outliers, 100);
  EXPECT_LT(kept, outliers / 20);
  EXPECT_LT(lost, static_cast<int>(scene.outlier.size()) / 8);
  EXPECT_LT(worst_pose_error(scene, problem), 0.03);
}

TEST(BundleAdjustment, LeavesFixedPosesAlone) {
  const BundleScene scene = make_bundle_scene(small());
  BundleProblem problem = scene.problem;
  problem.poses[5].fixed = true;
  ASSERT_TRUE(adjust_bundle(problem, BundleOptions()).usable);
  for (const std::size_t i : {0U, 1U, 5U}) {
    EXPECT_EQ(problem.poses[i].world_from_camera.matrix(),
              scene.problem.poses[i].world_from_camera.matrix());
  }
  EXPECT_NE(problem.poses[3].world_from_camera.matrix(),
            scene.problem.poses[3].world_from_camera.matrix());
}

TEST(BundleAdjustment, HoldsTheFirstPoseIfNoneIsFixed) {
  BundleSceneOptions options = small();
  options.fixed_poses = 0;
  const BundleScene scene = make_bundle_scene(options);
  BundleProblem problem = scene.problem;
  ASSERT_TRUE(adjust_bundle(problem, patient()).usable);
  EXPECT_EQ(problem.poses[0].world_from_camera.matrix(),
            scene.problem.poses[0].world_from_camera.matrix());
  // All relative to the held one, the truth comes out.
  const SE3 moved = problem.poses[0].world_from_camera * scene.true_world_from_camera[0].inverse();
  for (std::size_t i = 0; i < problem.poses.size(); ++i) {
    EXPECT_LT(translation_distance(problem.poses[i].world_from_camera,
                                   moved * scene.true_world_from_camera[i]),
              0.05);
  }
}

TEST(BundleAdjustment, MovesOnlyPointsIfAllPosesAreFixed) {
  BundleSceneOptions options = small();
  options.fixed_poses = options.poses;
  options.pixel_noise = 0.0;
  const BundleScene scene = make_bundle_scene(options);
  BundleProblem problem = scene.problem;
  ASSERT_TRUE(adjust_bundle(problem, patient()).usable);
  EXPECT_EQ(worst_pose_error(scene, problem), 0.0);
  EXPECT_LT(worst_point_error(scene, problem), 1e-5);
}

TEST(BundleAdjustment, ChangesNothingWhenCancelled) {
  const BundleScene scene = make_bundle_scene(small());
  BundleProblem problem = scene.problem;
  const BundleReport report = adjust_bundle(problem, BundleOptions(), [] { return false; });
  EXPECT_TRUE(report.cancelled);
  EXPECT_FALSE(report.usable);
  expect_same(problem, scene.problem);
  EXPECT_EQ(report.inlier.size(), problem.observations.size());
}

TEST(BundleAdjustment, RunsToTheEndWhileStopIsNotRaised) {
  const BundleScene scene = make_bundle_scene(small());
  BundleProblem problem = scene.problem;
  EXPECT_TRUE(adjust_bundle(problem, BundleOptions(), [] { return true; }).usable);
}

TEST(BundleAdjustment, GivesTheSameAnswerTwice) {
  const BundleScene scene = make_bundle_scene(small());
  BundleProblem a = scene.problem;
  BundleProblem b = scene.problem;
  adjust_bundle(a, BundleOptions());
  adjust_bundle(b, BundleOptions());
  expect_same(a, b);
}

TEST(BundleAdjustment, SolvesMorePosesThanTheLocalSolverTakes) {
  BundleSceneOptions options;
  options.poses = 410;
  options.points = 1600;
  options.pose_noise = 0.005;
  const BundleScene scene = make_bundle_scene(options);
  BundleProblem problem = scene.problem;
  const BundleReport report = adjust_bundle(problem, BundleOptions());
  ASSERT_TRUE(report.usable);
  EXPECT_LT(report.final_cost, 0.2 * report.initial_cost);
  BundleProblem again = scene.problem;
  adjust_bundle(again, BundleOptions());
  expect_same(problem, again);
}

TEST(BundleAdjustment, PutsUpWithPointsBehindTheCamera) {
  const BundleScene scene = make_bundle_scene(small());
  BundleProblem problem = scene.problem;
  const int seen = problem.observations[40].point;
  problem.points[static_cast<std::size_t>(seen)] =
      problem.poses[0].world_from_camera * Eigen::Vector3d(0.0, 0.0, -3.0);
  const BundleReport report = adjust_bundle(problem, BundleOptions());
  ASSERT_TRUE(report.usable);
  EXPECT_EQ(report.inlier[40], 0);
  EXPECT_LT(worst_pose_error(scene, problem), 0.05);
}

TEST(BundleAdjustment, SetsValuesThatAreNotFiniteAside) {
  const BundleScene scene = make_bundle_scene(small());
  BundleProblem problem = scene.problem;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  problem.observations[0].measured.pixel.x() = nan;
  problem.observations[1].measured.disparity = nan;
  problem.observations[2].measured.sigma = 0.0;
  const int seen = problem.observations[60].point;
  problem.points[static_cast<std::size_t>(seen)].z() = nan;
  const BundleReport report = adjust_bundle(problem, BundleOptions());
  ASSERT_TRUE(report.usable);
  for (const std::size_t i : {0U, 1U, 2U, 60U}) EXPECT_EQ(report.inlier[i], 0) << i;
  EXPECT_LT(worst_pose_error(scene, problem), 0.05);
}

TEST(BundleAdjustment, HandlesAPoseThatSeesAPointTwice) {
  BundleSceneOptions options = small();
  options.pixel_noise = 0.0;
  const BundleScene scene = make_bundle_scene(options);
  BundleProblem problem = scene.problem;
  for (std::size_t i = 0; i < 100; ++i) problem.observations.push_back(problem.observations[3 * i]);
  ASSERT_TRUE(adjust_bundle(problem, patient()).usable);
  EXPECT_LT(worst_pose_error(scene, problem), 1e-5);
}

TEST(BundleAdjustment, HandlesProblemsWithLittleOrNothingInThem) {
  BundleProblem empty;
  const BundleReport nothing = adjust_bundle(empty, BundleOptions());
  EXPECT_FALSE(nothing.cancelled);
  EXPECT_EQ(nothing.final_cost, 0.0);

  BundleProblem lonely;
  lonely.rig = Rig(test_camera());
  lonely.poses.resize(2);
  lonely.points.emplace_back(0.1, 0.2, 2.0);
  BundleProblem::Observation o;
  o.pose = 1;
  o.measured.pixel = {330.0, 250.0};
  lonely.observations.push_back(o);
  const BundleReport report = adjust_bundle(lonely, BundleOptions());
  EXPECT_TRUE(report.usable);
  EXPECT_LE(report.final_cost, report.initial_cost);
  EXPECT_TRUE(lonely.points[0].allFinite());
}

TEST(BundleAdjustment, ThrowsOnIndicesOutOfRange) {
  const BundleScene scene = make_bundle_scene(small());
  BundleProblem problem = scene.problem;
  problem.observations[7].pose = 8;
  EXPECT_THROW(adjust_bundle(problem, BundleOptions()), ContractError);
  problem = scene.problem;
  problem.observations[7].point = -1;
  EXPECT_THROW(adjust_bundle(problem, BundleOptions()), ContractError);
}

TEST(BundleAdjustment, OptionsHaveValidDefaults) {
  EXPECT_NO_THROW(validate_options("bundle", BundleOptions()));
}

}  // namespace
}  // namespace dxslam
