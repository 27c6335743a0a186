// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "tracking/recovery.h"

#include <gtest/gtest.h>

#include "core/error.h"

namespace dxslam {
namespace {

constexpr double kFrame = 1.0 / 30.0;

bool believes(double coverage, int inliers, double metres, double degrees, double seconds,
              bool was_tracking = true) {
  const SE3 moved(so3_exp({0.0, degrees * 0.017453, 0.0}), {metres, 0.0, 0.0});
  return is_believable_recovery({}, coverage, inliers, {moved, seconds, was_tracking});
}

TEST(Recovery, IsEasyNearby) {
  EXPECT_TRUE(believes(0.3, 26, 0.1, 5.0, kFrame));
  EXPECT_FALSE(believes(0.2, 500, 0.1, 5.0, kFrame)) << "one poster agrees, the rest does not";
}

TEST(Recovery, NeedsMoreAfterALoss) {
  EXPECT_FALSE(believes(0.4, 100, 0.1, 5.0, 0.5, false));
  EXPECT_TRUE(believes(0.5, 26, 0.1, 5.0, 0.5, false));
}

TEST(Recovery, NeedsMostWhereTheCameraCanHardlyBe) {
  EXPECT_FALSE(believes(0.5, 100, 2.0, 5.0, kFrame));
  EXPECT_FALSE(believes(0.5, 100, 0.1, 40.0, kFrame));
  EXPECT_FALSE(believes(1.0, 20, 2.0, 5.0, kFrame)) << "few points say all of this";
  EXPECT_TRUE(believes(0.6, 100, 2.0, 40.0, kFrame));
  EXPECT_FALSE(believes(0.5, 100, 3.0, 5.0, 100.0, false)) << "time makes no place near for ever";
}

TEST(Recovery, KnowsNoTimeWhereTheClockJumpedBack) {
  EXPECT_TRUE(believes(0.3, 26, 1.0, 60.0, -5.0));
  EXPECT_TRUE(believes(0.3, 26, 1.0, 60.0, 0.0));
}

TEST(Recovery, OptionsMustFitEachOther) {
  RecoveryOptions options;
  options.min_coverage = 0.6;
  EXPECT_THROW(validate_options("recovery", options), InputError);
}

}  // namespace
}  // namespace dxslam
