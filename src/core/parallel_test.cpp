// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "core/parallel.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "core/test_threads.h"

namespace dxslam {
namespace {

TEST(InParallel, EachIndexHasItsTurnOnce) {
  for (const int threads : {0, 1, 3, 50}) {
    for (const std::size_t n : {0U, 1U, 7U, 1000U}) {
      std::vector<int> turns(n, 0);
      in_parallel(n, threads, [&](std::size_t i) { ++turns[i]; });
      EXPECT_EQ(turns, std::vector<int>(n, 1)) << n << " by " << threads;
    }
  }
}

TEST(InParallel, AnExceptionComesOutAndEndsTheWork) {
  std::atomic<int> calls{0};
  const auto work = [&](std::size_t i) {
    ++calls;
    if (i == 3) throw std::runtime_error("three");
  };
  EXPECT_THROW(in_parallel(1000000, 2, work), std::runtime_error);
  EXPECT_LT(calls, 1000000);
}

TEST(InParallel, DoesAllTheWorkWithoutHelpers) {
  const NoMoreThreads none;
  std::vector<int> turns(100, 0);
  in_parallel(turns.size(), 8, [&](std::size_t i) { ++turns[i]; });
  EXPECT_EQ(turns, std::vector<int>(100, 1));
}

TEST(ParallelRanges, CoverTheRangeWithoutGapOrOverlap) {
  for (const int threads : {0, 1, 4, 9}) {
    for (const int count : {0, 1, 5, 480}) {
      std::vector<int> turns(static_cast<std::size_t>(count), 0);
      parallel_ranges(count, threads, [&](int begin, int end) {
        for (int i = begin; i < end; ++i) ++turns[static_cast<std::size_t>(i)];
      });
      EXPECT_EQ(turns, std::vector<int>(static_cast<std::size_t>(count), 1));
    }
  }
}

}  // namespace
}  // namespace dxslam
