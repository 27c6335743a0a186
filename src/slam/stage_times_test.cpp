// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "slam/stage_times.h"

#include <gtest/gtest.h>
#include <malloc.h>

#include <algorithm>
#include <numeric>
#include <random>

namespace dxslam {
namespace {

TEST(StageTimes, AreRightToOnePercent) {
  std::mt19937 generator(3);
  std::lognormal_distribution<double> ms(1.5, 2.0);
  std::vector<double> all;
  StageTimes times;
  for (int i = 0; i < 2001; ++i) times.add("stage", all.emplace_back(ms(generator)));
  std::sort(all.begin(), all.end());
  const StageSummary s = times.summaries().at("stage");
  EXPECT_EQ(s.count, all.size());
  EXPECT_NEAR(s.median_ms, all[1000], 0.01 * all[1000]);
  EXPECT_NEAR(s.p95_ms, all[1900], 0.01 * all[1900]);
  EXPECT_EQ(s.max_ms, all.back());
  EXPECT_NEAR(s.total_ms, std::accumulate(all.begin(), all.end(), 0.0), 1e-6);
}

TEST(StageTimes, OneTimeIsExact) {
  StageTimes times;
  for (const double ms : {0.0, 1e-9, 7.7, 1e9}) times.add(std::to_string(ms), ms);
  EXPECT_TRUE(StageTimes().summaries().empty());
  EXPECT_EQ(times.summaries().at("7.700000").median_ms, 7.7);
  EXPECT_EQ(times.summaries().at("1000000000.000000").p95_ms, 1e9);
}

TEST(StageTimes, DoNotGrow) {
  StageTimes times;
  times.add("stage", 1.0);
  const std::size_t heap = mallinfo2().uordblks + mallinfo2().hblkhd;
  for (int i = 0; i < 1000000; ++i) times.add("stage", 1e-3 * i);
  EXPECT_LE(mallinfo2().uordblks + mallinfo2().hblkhd, heap);
}

}  // namespace
}  // namespace dxslam
