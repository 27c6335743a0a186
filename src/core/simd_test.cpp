// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "core/simd.h"

#include <gtest/gtest.h>

#include <numeric>
#include <vector>

#include "core/test_simd.h"

namespace dxslam {
namespace {

DXSLAM_INLINE_KERNEL int scaled_sum(const std::vector<int>& values, int scale) {
  int sum = 0;
  for (const int v : values) sum += scale * v;
  return sum;
}

TEST(Simd, AKernelGivesTheSameAtEachLevel) {
  std::vector<int> values(1003);
  std::iota(values.begin(), values.end(), -400);
  const int expected = 3 * std::accumulate(values.begin(), values.end(), 0);
  for (const SimdLevel level : testing_support::simd_levels()) {
    set_simd_level(level);
    EXPECT_EQ(simd_level(), level);
    EXPECT_EQ(simd_kernel<scaled_sum>()(values, 3), expected);
  }
}

TEST(Simd, EachLevelHasAVariantOfItsOwn) {
  const SimdLevel highest = simd_level();
  const auto best = simd_kernel<scaled_sum>();
  set_simd_level(SimdLevel::kPortable);
  const auto portable = simd_kernel<scaled_sum>();
  EXPECT_EQ(simd_level(), SimdLevel::kPortable);
  set_simd_level(SimdLevel::kAvx512);
  EXPECT_EQ(simd_level(), highest) << "no higher than the processor's";
  EXPECT_EQ(best == portable, highest == SimdLevel::kPortable);
}

}  // namespace
}  // namespace dxslam
