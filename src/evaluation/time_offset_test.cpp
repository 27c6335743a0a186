// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "evaluation/time_offset.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "evaluation/ate.h"

namespace dxslam {
namespace {

SE3 pose_at(double t) {
  return SE3::exp((Vector6d() << 2.0 * std::sin(0.7 * t), std::cos(1.1 * t),
                   0.3 * std::sin(3.0 * t), 0.2 * t, 0.1 * t, 0.0)
                      .finished());
}

// `count` poses of a walk, `step` seconds apart, whose clock shows `late` seconds too much.
Trajectory walk(int count, double step, double late) {
  Trajectory poses;
  for (int i = 0; i < count; ++i) poses.push_back({1.4e9 + step * i + late, pose_at(step * i)});
  return poses;
}

TEST(TimeOffset, IsFoundToATenthOfAMillisecond) {
  const Trajectory truth = walk(2000, 0.01, 0.0);
  const SE3 moved = SE3::exp((Vector6d() << 1.0, -2.0, 0.5, 0.3, -0.8, 1.1).finished());
  for (const double late : {0.0, 0.0123, -0.4321, 0.95}) {
    Trajectory estimate = walk(600, 0.033, late);
    for (StampedPose& pose : estimate) pose.world_from_camera = moved * pose.world_from_camera;
    const TimeOffset found = search_time_offset(truth, estimate);
    EXPECT_NEAR(found.offset, -late, 1e-4);
    EXPECT_FALSE(found.at_edge);
    EXPECT_LT(found.rmse, 1e-3);
    const AteReport before = evaluate_ate(truth, estimate, {Alignment::kSe3, 0.02});
    const AteReport after =
        evaluate_ate(truth, shifted(estimate, found.offset), {Alignment::kSe3, 0.02});
    EXPECT_LE(after.position.rmse, before.position.rmse + 1e-6);
    EXPECT_LT(after.position.rmse, 0.01);
  }
}

TEST(TimeOffset, IsLikelyOnlyWhereItExplainsTheError) {
  const Trajectory truth = walk(2000, 0.01, 0.0);
  const Trajectory late = walk(600, 0.033, 0.5);
  const auto found = likely_offset(truth, late, evaluate_ate(truth, late).position.rmse);
  ASSERT_TRUE(found.has_value());
  EXPECT_NEAR(found->offset, -0.5, 1e-3);
  Trajectory noisy = walk(600, 0.03, 0.0);
  for (std::size_t i = 0; i < noisy.size(); ++i) {
    const double error = 0.2 * std::sin(0.05 * static_cast<double>(i * i));
    const Eigen::Vector3d moved(error, -error, 0.5 * error);
    noisy[i].world_from_camera = SE3(noisy[i].world_from_camera.rotation(),
                                     noisy[i].world_from_camera.translation() + moved);
  }
  EXPECT_FALSE(likely_offset(truth, noisy, evaluate_ate(truth, noisy).position.rmse));
  EXPECT_FALSE(likely_offset(truth, walk(5, 0.03, 0.5), 1.0)) << "too few";
}

TEST(TimeOffset, SaysWhenTheRangeIsTooSmall) {
  const Trajectory truth = walk(2000, 0.01, 0.0);
  EXPECT_TRUE(
      search_time_offset(truth, walk(500, 0.033, 0.3), {0.2, 0.5, Alignment::kSe3}).at_edge);
  EXPECT_THROW(search_time_offset(truth, walk(500, 0.033, 5000.0)), InputError);
  EXPECT_THROW(search_time_offset(truth, walk(2, 0.033, 0.0)), InputError);
  EXPECT_THROW(search_time_offset({}, truth), ContractError);
}

}  // namespace
}  // namespace dxslam
