// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "slam/right_of_way.h"

#include <gtest/gtest.h>

#include <atomic>
#include <optional>
#include <thread>

namespace dxslam {
namespace {

constexpr auto kForever = std::chrono::hours(1);

TEST(RightOfWay, NobodyWaitsWithoutAClaim) {
  RightOfWay way;
  way.wait(kForever);
  {
    const RightOfWay::Claim claim(way);
  }
  way.wait(kForever);
}

TEST(RightOfWay, AWaitEndsWithTheLastClaim) {
  RightOfWay way;
  std::optional<RightOfWay::Claim> first(std::in_place, way);
  std::optional<RightOfWay::Claim> second(std::in_place, way);
  std::atomic<bool> through{false};
  std::atomic<bool> last_ended{false};
  std::thread waiting([&] {
    way.wait(kForever);
    through = last_ended.load();
  });
  first.reset();
  std::this_thread::sleep_for(std::chrono::milliseconds(5));
  last_ended = true;
  second.reset();
  waiting.join();
  EXPECT_TRUE(through);
}

// Mapping gives way with the map in hand, and relocalization waits for the map.
TEST(RightOfWay, AHurryEndsTheWaiting) {
  RightOfWay way;
  const RightOfWay::Claim claim(way);
  std::thread waiting([&] { way.wait(kForever); });
  std::this_thread::sleep_for(std::chrono::milliseconds(5));
  const RightOfWay::Hurry hurry(way);
  waiting.join();
  way.wait(kForever);  // nor does anybody wait from now on
}

TEST(RightOfWay, AClaimThatNeverEndsHoldsNobodyForGood) {
  RightOfWay way;
  const RightOfWay::Claim claim(way);
  GiveWay give_way(way);
  GiveWay::Clock::duration waited{0};
  for (int i = 0; i < 100; ++i) {
    std::this_thread::sleep_for(std::chrono::microseconds(100));  // the work
    const auto start = GiveWay::Clock::now();
    give_way();
    waited += GiveWay::Clock::now() - start;
  }
  EXPECT_GT(waited, std::chrono::milliseconds(5));  // about as long as it worked
}

}  // namespace
}  // namespace dxslam
