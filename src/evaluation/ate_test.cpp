// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "evaluation/ate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"

namespace dxslam {
namespace {

Trajectory helix(int count) {
  Trajectory trajectory;
  for (int i = 0; i < count; ++i) {
    const double t = 0.1 * i;
    trajectory.push_back(
        {t, SE3::exp((Vector6d() << std::cos(t), std::sin(t), t, 0.1 * t, 0.2, 0).finished())});
  }
  return trajectory;
}

TEST(Statistics, OfAFewNumbers) {
  const ErrorStatistics s = summarise({4.0, 1.0, 2.0, 5.0});
  EXPECT_DOUBLE_EQ(s.mean, 3.0);
  EXPECT_DOUBLE_EQ(s.median, 3.0);
  EXPECT_DOUBLE_EQ(s.rmse, std::sqrt(46.0 / 4.0));
  EXPECT_DOUBLE_EQ(s.std, std::sqrt(10.0 / 4.0));
  EXPECT_DOUBLE_EQ(s.min, 1.0);
  EXPECT_DOUBLE_EQ(s.max, 5.0);
  EXPECT_EQ(s.count, 4U);
  EXPECT_EQ(summarise({}).count, 0U);
  EXPECT_DOUBLE_EQ(summarise({3.0, 1.0, 2.0}).median, 2.0);
}

TEST(Associate, TakesTheNearestStampWithinReach) {
  const Trajectory truth = helix(10);
  const Trajectory estimate = {{0.104, {}}, {0.36, {}}, {0.44, {}}, {0.55, {}}, {2.0, {}}};
  const auto pairs = associate(truth, estimate, 0.045);
  ASSERT_EQ(pairs.size(), 3U);
  EXPECT_DOUBLE_EQ(pairs[0].truth.stamp, 0.1);
  EXPECT_DOUBLE_EQ(pairs[1].truth.stamp, 0.4);
  EXPECT_DOUBLE_EQ(pairs[2].truth.stamp, 0.4);
  EXPECT_DOUBLE_EQ(pairs[2].estimate.stamp, 0.44);
}

TEST(Associate, RefusesWhatDoesNotMatch) {
  const Trajectory late = {{100.0, {}}};
  EXPECT_TRUE(associate(helix(3), late, 0.01).empty());
  try {
    associate_or_throw(helix(3), late, 0.01);
    FAIL();
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), testing::HasSubstr("(0 to 0.2 s)"));
    EXPECT_THAT(e.what(), testing::HasSubstr("(100 to 100 s)"));
  }
  EXPECT_TRUE(associate({}, late, 0.01).empty());
  EXPECT_THROW(associate_or_throw({}, late, 0.01), InputError);
  EXPECT_THROW(associate_or_throw(late, {}, 0.01), InputError);
  EXPECT_THROW(associate({{1, {}}, {0, {}}}, late, 0.01), ContractError);
}

TEST(Ate, IsZeroForAMovedCopyAndFindsTheMotion) {
  const Trajectory truth = helix(50);
  const SE3 motion = SE3::exp((Vector6d() << 3, 2, 1, 0.4, -1.0, 2.0).finished());
  const Trajectory estimate = transformed(truth, Sim3(motion));
  const AteReport report = evaluate_ate(truth, estimate);
  EXPECT_LT(report.position.max, 1e-9);
  EXPECT_EQ(report.position.count, 50U);
  const SE3 found = report.truth_from_estimate.rigid() * motion;
  EXPECT_LT(found.log().norm(), 1e-8);
  // The aligned estimates are turned as well.
  EXPECT_LT(rotation_angle(report.pairs[7].estimate.world_from_camera,
                           report.pairs[7].truth.world_from_camera),
            1e-7);
}

TEST(Ate, ScaleIsFittedOnlyWhenAsked) {
  const Trajectory truth = helix(50);
  const Trajectory estimate =
      transformed(truth, Sim3(0.5, Eigen::Quaterniond::Identity(), {1, 2, 3}));
  EXPECT_GT(evaluate_ate(truth, estimate).position.rmse, 0.1);
  const AteReport report = evaluate_ate(truth, estimate, {Alignment::kSim3, 0.01});
  EXPECT_LT(report.position.rmse, 1e-9);
  EXPECT_NEAR(report.truth_from_estimate.scale(), 2.0, 1e-9);
}

TEST(Ate, WithoutAlignmentIsThePlainDistance) {
  const Trajectory truth = helix(20);
  const Trajectory estimate =
      transformed(truth, Sim3(1.0, Eigen::Quaterniond::Identity(), {0, 3, 4}));
  const AteReport report = evaluate_ate(truth, estimate, {Alignment::kNone, 0.01});
  EXPECT_NEAR(report.position.min, 5.0, 1e-12);
  EXPECT_NEAR(report.position.max, 5.0, 1e-12);
}

TEST(Ate, RefusesPosesOnOneLine) {
  Trajectory line;
  for (int i = 0; i < 9; ++i)
    line.push_back({0.1 * i, {Eigen::Quaterniond::Identity(), {1.0 * i, 0, 0}}});
  EXPECT_THROW(evaluate_ate(line, line), InputError);
  EXPECT_EQ(evaluate_ate(line, line, {Alignment::kNone, 0.01}).position.max, 0.0);
}

}  // namespace
}  // namespace dxslam
