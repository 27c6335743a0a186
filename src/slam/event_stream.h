// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <limits>
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
  /// A queue that loses nothing: for readers whose result needs every message, such as a file of
  /// all poses. Nobody waits for it either, so it grows while its reader is slow. Ask it for small
  /// kinds alone: a FrameTracked has about 1 KiB, a MapChanged as much as the map that moved.
  static constexpr std::size_t kUnbounded = std::numeric_limits<std::size_t>::max();

  Subscription(std::size_t capacity, EventKinds kinds) : capacity_(capacity), kinds_(kinds) {}

  /// The next message; waits for it at most `timeout`. Null at the timeout, and once the stream has
  /// ended and all was read (see has_ended()).
  MessagePtr next(std::chrono::milliseconds timeout);
  /// The next message, or null if there is none yet.
  MessagePtr try_next() { return next(std::chrono::milliseconds(0)); }
  /// Whether nothing can come any more.
  bool has_ended() const;
  /// Messages lost so far, because they were read too slowly. Message::number shows where.
  std::uint64_t lost() const;
  /// Nothing comes any more; what is in the queue can still be read.
  void end();

 private:
  friend class EventStream;
  void put(const MessagePtr& message);

  const std::size_t capacity_;
  const EventKinds kinds_;
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

  /// Messages of these kinds from now on. They end when the stream or the last copy of the pointer
  /// goes. `capacity`: at least 1, or Subscription::kUnbounded.
  SubscriptionPtr subscribe(std::size_t capacity = 1024, EventKinds kinds = EventKinds::all());
  /// Whether anybody reads such: else messages need not be made.
  template <class Wanted>
  bool has_readers_of() const {
    return wanted_.load(std::memory_order_relaxed).has_any(EventKinds::of<Wanted>());
  }
  void publish(Event event);
  /// The map has changed once more, which its version says whether or not anybody reads the rest.
  void publish_change(MapChanged change);
  std::uint64_t map_version() const { return map_version_.load(); }
  /// Nothing is published any more; what is in the queues can still be read.
  void end();

 private:
  void send(Event event);
  void forget_gone();

  std::mutex mutex_;
  std::vector<std::weak_ptr<Subscription>> subscriptions_;  // guarded by mutex_
  std::uint64_t number_ = 0;                                // guarded by mutex_
  bool ended_ = false;                                      // guarded by mutex_
  std::atomic<std::uint64_t> map_version_{0};
  std::atomic<EventKinds> wanted_{EventKinds::none()};  // by any reader
};

}  // namespace dxslam
