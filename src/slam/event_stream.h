// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "slam/observer.h"

namespace dxslam {

/// One reader's queue of an EventStream. Holds at most its capacity; where messages come faster
/// than they are read, the oldest go, and are counted. Any thread may call any member.
class Subscription {
 public:
  explicit Subscription(std::size_t capacity) : capacity_(capacity) {}

  /// The next message; waits for it at most `timeout`. Null at the timeout, and once the stream has
  /// ended and all was read (see has_ended()).
  MessagePtr next(std::chrono::milliseconds timeout);
  /// The next message, or null if there is none yet.
  MessagePtr try_next() { return next(std::chrono::milliseconds(0)); }
  /// Whether nothing can come any more.
  bool has_ended() const;
  /// Messages lost so far, because they were read too slowly. Message::number shows where.
  std::uint64_t lost() const;

 private:
  friend class EventStream;
  void put(const MessagePtr& message);
  void end();

  const std::size_t capacity_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<MessagePtr> messages_;
  std::uint64_t lost_ = 0;
  bool ended_ = false;
};

using SubscriptionPtr = std::shared_ptr<Subscription>;

/// Hands messages to all who subscribed, in the order in which they were published. Publishing
/// never waits for a reader. Any thread may call any member.
class EventStream {
 public:
  EventStream() = default;
  ~EventStream() { end(); }
  EventStream(const EventStream&) = delete;
  EventStream& operator=(const EventStream&) = delete;

  /// Messages from now on. They end when the stream or the last copy of the pointer goes.
  SubscriptionPtr subscribe(std::size_t capacity = 1024);
  /// Whether anybody reads: else messages need not be made.
  bool has_readers() const { return readers_.load(std::memory_order_relaxed) > 0; }
  void publish(Event event);
  /// The map has changed once more; for MapChanged.
  void publish_change(MapChanged change);
  std::uint64_t map_version() const { return map_version_.load(); }
  /// Nothing is published any more; what is in the queues can still be read.
  void end();

 private:
  void send(Event event);

  std::mutex mutex_;
  std::vector<std::weak_ptr<Subscription>> subscriptions_;  // guarded by mutex_
  std::uint64_t number_ = 0;                                // guarded by mutex_
  bool ended_ = false;                                      // guarded by mutex_
  std::atomic<std::uint64_t> map_version_{0};
  std::atomic<int> readers_{0};
};

}  // namespace dxslam
