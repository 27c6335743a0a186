// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "slam/event_reader.h"

#include <gtest/gtest.h>

#include <future>
#include <stdexcept>
#include <vector>

#include "core/error.h"
#include "core/test_threads.h"

namespace dxslam {
namespace {

TEST(EventReader, ReadsAllUntilTheEnd) {
  EventStream stream;
  std::vector<int> seen;
  EventReader reader(stream.subscribe(), [&](const Message& message) {
    seen.push_back(std::get<RecordingBegun>(message.event).number);
  });
  for (int i = 0; i < 100; ++i) stream.publish(RecordingBegun{i});
  stream.end();
  reader.wait();
  reader.wait();
  ASSERT_EQ(seen.size(), 100U);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(seen[static_cast<std::size_t>(i)], i);
  EXPECT_EQ(reader.lost(), 0U);
  EXPECT_EQ(reader.failures().count, 0);
}

// However often it throws, and whatever.
TEST(EventReader, WhatAReaderThrowsEndsNothing) {
  EventStream stream;
  int calls = 0;
  EventReader reader(stream.subscribe(), [&](const Message&) {
    if (++calls % 2 == 1) throw std::runtime_error("disk full");
    if (calls == 4) throw 5;
  });
  for (int i = 0; i < 6; ++i) stream.publish(RecordingBegun{i});
  stream.end();
  reader.wait();
  EXPECT_EQ(calls, 6);
  EXPECT_EQ(reader.failures().count, 4);
  EXPECT_EQ(reader.failures().first, "disk full");
}

// As where an exception ends its scope before the system has finished.
TEST(EventReader, GoesBeforeTheStreamEnds) {
  EventStream stream;
  int calls = 0;
  {
    EventReader reader(stream.subscribe(), [&](const Message&) { ++calls; });
    for (int i = 0; i < 6; ++i) stream.publish(RecordingBegun{i});
  }
  EXPECT_EQ(calls, 6);
  stream.publish(RecordingBegun{6});
  EXPECT_FALSE(stream.has_readers_of<RecordingBegun>());
}

TEST(EventReader, NobodyWaitsForAStuckOne) {
  EventStream stream;
  std::promise<void> release;
  std::shared_future<void> released = release.get_future().share();
  EventReader reader(stream.subscribe(2), [&](const Message&) { released.wait(); });
  for (int i = 0; i < 1000; ++i) stream.publish(RecordingBegun{i});
  release.set_value();
  stream.end();
  reader.wait();
  EXPECT_GE(reader.lost(), 997U);
}

TEST(EventReader, IsRefusedInOneSentenceWhereThereIsNoThread) {
  EventStream stream;
  const NoMoreThreads none;
  EXPECT_THROW(EventReader(stream.subscribe(), [](const Message&) {}), InputError);
}

}  // namespace
}  // namespace dxslam
