// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "slam/fair_mutex.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <mutex>
#include <thread>

namespace dxslam {
namespace {

// As mapping does, which always has a next keyframe.
TEST(FairMutex, IsHadBetweenTwoPiecesOfWork) {
  FairMutex mutex;
  std::atomic<bool> begun{false};
  std::atomic<bool> stop{false};
  std::atomic<int> pieces{0};
  std::thread busy([&] {
    while (!stop) {
      const std::lock_guard lock(mutex);
      begun = true;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      ++pieces;
    }
  });
  while (!begun) std::this_thread::yield();
  constexpr int kTurns = 20;
  for (int i = 0; i < kTurns; ++i) {
    const std::lock_guard lock(mutex);
  }
  const int done = pieces;
  stop = true;
  busy.join();
  EXPECT_LT(done, 20 * kTurns);
}

}  // namespace
}  // namespace dxslam
