// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "slam/event_stream.h"

#include <gtest/gtest.h>

#include <thread>
#include <variant>

#include "core/error.h"

namespace dxslam {
namespace {

using std::chrono::milliseconds;

int recording_of(const MessagePtr& message) {
  return std::get<RecordingBegun>(message->event).number;
}

TEST(EventStream, GivesEveryReaderEveryMessageInOrder) {
  EventStream stream;
  stream.publish(RecordingBegun{0});  // nobody listens yet
  const SubscriptionPtr a = stream.subscribe();
  const SubscriptionPtr b = stream.subscribe();
  stream.publish(RecordingBegun{1});
  stream.publish_change({});
  stream.publish(RecordingBegun{2});
  stream.end();
  for (const SubscriptionPtr& reader : {a, b}) {
    const MessagePtr first = reader->try_next();
    const MessagePtr second = reader->try_next();
    const MessagePtr third = reader->try_next();
    ASSERT_TRUE(first && second && third);
    EXPECT_EQ(recording_of(first), 1);
    EXPECT_EQ(first->map_version, 0U);
    EXPECT_TRUE(std::holds_alternative<MapChanged>(second->event));
    EXPECT_EQ(second->map_version, 1U);
    EXPECT_EQ(third->map_version, 1U);
    EXPECT_EQ(third->number, first->number + 2);
    EXPECT_TRUE(reader->has_ended());
    EXPECT_EQ(reader->next(milliseconds(10000)), nullptr);  // at once
    EXPECT_EQ(reader->lost(), 0U);
  }
}

TEST(EventStream, ASlowReaderLosesTheOldestAndIsTold) {
  EventStream stream;
  const SubscriptionPtr slow = stream.subscribe(3);
  const SubscriptionPtr quick = stream.subscribe(100);
  for (int i = 0; i < 10; ++i) stream.publish(RecordingBegun{i});
  EXPECT_EQ(slow->lost(), 7U);
  EXPECT_EQ(recording_of(slow->try_next()), 7);
  EXPECT_EQ(slow->try_next()->number, 9U);
  EXPECT_EQ(quick->lost(), 0U);
  EXPECT_EQ(recording_of(quick->try_next()), 0);
}

TEST(EventStream, GivesAReaderTheKindsThatItAskedFor) {
  EventStream stream;
  const auto kinds = EventKinds::of<RecordingBegun, MapSaved>();
  SubscriptionPtr some = stream.subscribe(2, kinds);
  EXPECT_TRUE(stream.has_readers_of<MapSaved>());
  EXPECT_FALSE(stream.has_readers_of<MapChanged>());
  const SubscriptionPtr others = stream.subscribe(2, EventKinds::of<MapChanged>());
  EXPECT_TRUE(stream.has_readers_of<MapChanged>());
  for (int i = 0; i < 3; ++i) stream.publish_change({});
  stream.publish(MapSaved{"a"});
  stream.publish(RunFailed{"b"});
  EXPECT_EQ(some->lost(), 0U);
  EXPECT_EQ(others->lost(), 1U);
  const MessagePtr first = some->try_next();
  EXPECT_EQ(std::get<MapSaved>(first->event).path, "a");
  EXPECT_EQ(first->map_version, 3U);
  EXPECT_EQ(some->try_next(), nullptr);
  some.reset();
  stream.publish_change({});
  EXPECT_FALSE(stream.has_readers_of<MapSaved>());
  EXPECT_TRUE(stream.has_readers_of<MapChanged>());
}

TEST(EventStream, AnUnboundedQueueLosesNothing) {
  EventStream stream;
  const SubscriptionPtr reader = stream.subscribe(Subscription::kUnbounded);
  for (int i = 0; i < 5000; ++i) stream.publish(RecordingBegun{i});
  for (int i = 0; i < 5000; ++i) ASSERT_EQ(recording_of(reader->try_next()), i);
  EXPECT_EQ(reader->lost(), 0U);
}

TEST(EventStream, AReaderEndsForItself) {
  EventStream stream;
  const SubscriptionPtr reader = stream.subscribe();
  const SubscriptionPtr other = stream.subscribe();
  stream.publish(RecordingBegun{0});
  reader->end();
  stream.publish(RecordingBegun{1});
  EXPECT_EQ(recording_of(reader->try_next()), 0);
  EXPECT_TRUE(reader->has_ended());
  EXPECT_EQ(recording_of(other->try_next()), 0);
  EXPECT_EQ(recording_of(other->try_next()), 1);
  EXPECT_FALSE(other->has_ended());
}

TEST(EventStream, WaitsAsLongAsOneLikes) {
  EventStream stream;
  const SubscriptionPtr reader = stream.subscribe();
  std::thread later([&] { stream.publish(RecordingBegun{3}); });
  EXPECT_EQ(recording_of(reader->next(milliseconds::max())), 3);
  later.join();
}

TEST(EventStream, ForgetsReadersThatAreGone) {
  EventStream stream;
  EXPECT_FALSE(stream.has_readers_of<RecordingBegun>());
  SubscriptionPtr reader = stream.subscribe();
  EXPECT_TRUE(stream.has_readers_of<RecordingBegun>());
  reader.reset();
  stream.publish(RecordingBegun{});
  EXPECT_FALSE(stream.has_readers_of<RecordingBegun>());
  EXPECT_THROW(stream.subscribe(0), ContractError);
}

TEST(EventStream, AWaitingReaderIsWokenByMessagesAndTheEnd) {
  auto stream = std::make_unique<EventStream>();
  const SubscriptionPtr reader = stream->subscribe();
  EXPECT_EQ(reader->next(milliseconds(1)), nullptr);
  EXPECT_FALSE(reader->has_ended());
  int seen = 0;
  std::thread thread([&] {
    while (!reader->has_ended()) {
      if (reader->next(milliseconds(60000))) ++seen;
    }
  });
  for (int i = 0; i < 500; ++i) stream->publish(RecordingBegun{i});
  stream.reset();  // its end is that of the stream
  thread.join();
  EXPECT_EQ(seen, 500);
  EXPECT_EQ(reader->lost(), 0U);
}

}  // namespace
}  // namespace dxslam
