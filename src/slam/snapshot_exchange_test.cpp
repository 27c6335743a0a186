// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "slam/snapshot_exchange.h"

#include <gtest/gtest.h>

#include <memory>
#include <thread>

namespace dxslam {
namespace {

LocalMapPtr around(KeyframeId keyframe) {
  auto local_map = std::make_shared<LocalMap>();
  local_map->reference = keyframe;
  return local_map;
}

TEST(SnapshotExchange, HandsOverTheNewestOnce) {
  SnapshotExchange exchange;
  EXPECT_EQ(exchange.take(), nullptr);
  const auto epoch = exchange.epoch();
  EXPECT_TRUE(exchange.publish(epoch, around(1)));
  EXPECT_TRUE(exchange.publish(epoch, around(2)));
  EXPECT_EQ(exchange.take()->reference, 2U);
  EXPECT_EQ(exchange.take(), nullptr);
}

// A request waits for mapping, relocalization finds the camera elsewhere, and only then mapping
// gets to the request.
TEST(SnapshotExchange, ARequestStillQueuedDoesNotOverrideARelocalization) {
  SnapshotExchange exchange;
  const auto asked = exchange.epoch();
  exchange.begin_epoch();  // found
  EXPECT_FALSE(exchange.publish(asked, around(1)));
  EXPECT_EQ(exchange.take(), nullptr);
  EXPECT_TRUE(exchange.publish(exchange.epoch(), around(7)));
  // Its second and third snapshot come later still.
  EXPECT_FALSE(exchange.publish(asked, around(1)));
  EXPECT_EQ(exchange.take()->reference, 7U);
}

TEST(SnapshotExchange, WhatIsOnItsWayDoesNotOutliveTheEpoch) {
  SnapshotExchange exchange;
  exchange.publish(exchange.epoch(), around(1));
  exchange.begin_epoch();
  EXPECT_EQ(exchange.take(), nullptr);
}

// The first keyframe of a new map is waited for: one of the old map must not end the waiting.
TEST(SnapshotExchange, WaitsForASnapshotOfItsEpoch) {
  SnapshotExchange exchange;
  const auto old = exchange.epoch();
  exchange.begin_epoch();
  std::thread mapping([&] {
    EXPECT_FALSE(exchange.publish(old, around(1)));
    EXPECT_TRUE(exchange.publish(exchange.epoch(), around(2)));
  });
  EXPECT_TRUE(exchange.wait());
  EXPECT_EQ(exchange.take()->reference, 2U);
  mapping.join();
}

TEST(SnapshotExchange, StoppingEndsTheWaiting) {
  SnapshotExchange exchange;
  std::thread stopping([&] { exchange.stop(); });
  EXPECT_FALSE(exchange.wait());
  stopping.join();
  EXPECT_FALSE(exchange.wait());
}

}  // namespace
}  // namespace dxslam
