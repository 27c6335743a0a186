// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "evaluation/rpe.h"

#include <gtest/gtest.h>

#include "core/error.h"

namespace dxslam {
namespace {

// Moves `step` metres along x and turns by `turn` radians about z each tenth of a second.
Trajectory steps(int count, double step, double turn) {
  Trajectory trajectory;
  SE3 pose;
  for (int i = 0; i < count; ++i) {
    trajectory.push_back({0.1 * i, pose});
    pose = pose * SE3(so3_exp({0, 0, turn}), {step, 0, 0});
  }
  return trajectory;
}

TEST(Rpe, MeasuresDriftOverTheDelta) {
  const Trajectory truth = steps(21, 1.0, 0.0);
  const Trajectory estimate = steps(21, 1.01, 0.0);
  RpeOptions options;
  EXPECT_NEAR(evaluate_rpe(truth, estimate, options).translation.rmse, 0.01, 1e-9);
  options.delta = 5;
  const RpeReport report = evaluate_rpe(truth, estimate, options);
  EXPECT_NEAR(report.translation.max, 0.05, 1e-9);
  EXPECT_EQ(report.translation.count, 16U);
  EXPECT_NEAR(report.rotation.max, 0.0, 1e-6);
  options.all_pairs = false;
  EXPECT_EQ(evaluate_rpe(truth, estimate, options).translation.count, 4U);
}

TEST(Rpe, MeasuresRotationInDegrees) {
  const double degree = 3.14159265358979323846 / 180.0;
  RpeOptions options;
  options.delta = 3;
  const RpeReport report = evaluate_rpe(steps(10, 0.0, 0.0), steps(10, 0.0, 0.5 * degree), options);
  EXPECT_NEAR(report.rotation.median, 1.5, 1e-9);
}

TEST(Rpe, SecondsFindThePoseNearestInTime) {
  RpeOptions options;
  options.delta = 0.52;
  options.unit = RpeOptions::Unit::kSeconds;
  const RpeReport report = evaluate_rpe(steps(21, 1.0, 0), steps(21, 1.01, 0), options);
  EXPECT_NEAR(report.translation.max, 0.05, 1e-9);
  EXPECT_EQ(report.translation.count, 16U);

  // A gap: no pose of the second half has a partner in the first.
  Trajectory gap = steps(21, 1.01, 0);
  gap.erase(gap.begin() + 5, gap.begin() + 15);
  options.delta = 0.3;
  EXPECT_EQ(evaluate_rpe(steps(21, 1.0, 0), gap, options).translation.count, 2U + 3U);
}

TEST(Rpe, RefusesImpossibleDeltas) {
  const Trajectory t = steps(10, 1.0, 0.1);
  for (const double delta : {0.0, -1.0, 1.5, 10.0, 1e300}) {
    RpeOptions options;
    options.delta = delta;
    EXPECT_THROW(evaluate_rpe(t, t, options), InputError) << delta;
  }
}

}  // namespace
}  // namespace dxslam
