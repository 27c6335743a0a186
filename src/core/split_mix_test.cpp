// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "core/split_mix.h"

#include <gtest/gtest.h>

namespace dxslam {
namespace {

// The published test vector of the generator with seed 1234567.
TEST(SplitMix64, GivesThePublishedNumbers) {
  SplitMix64 random(1234567);
  EXPECT_EQ(random.bits(), 6457827717110365317ULL);
  EXPECT_EQ(random.bits(), 3203168211198807973ULL);
  EXPECT_EQ(random.bits(), 9817491932198370423ULL);
}

TEST(SplitMix64, UniformNumbersLieBelowOne) {
  SplitMix64 random(7);
  double sum = 0.0;
  for (int i = 0; i < 1000; ++i) {
    const double x = random.uniform();
    ASSERT_GE(x, 0.0);
    ASSERT_LT(x, 1.0);
    sum += x;
  }
  EXPECT_NEAR(sum / 1000.0, 0.5, 0.05);
}

}  // namespace
}  // namespace dxslam
