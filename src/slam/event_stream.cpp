// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "slam/event_stream.h"

#include <algorithm>
#include <utility>

#include "core/error.h"

namespace dxslam {

MessagePtr Subscription::next(std::chrono::milliseconds timeout) {
  constexpr std::chrono::milliseconds kLongest =
      std::chrono::hours(24 * 365);  // of what a clock can
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, std::min(timeout, kLongest),
                    [&] { return ended_ || !messages_.empty(); });
  if (messages_.empty()) return nullptr;
  MessagePtr message = std::move(messages_.front());
  messages_.pop_front();
  return message;
}

bool Subscription::has_ended() const {
  const std::lock_guard lock(mutex_);
  return ended_ && messages_.empty();
}

std::uint64_t Subscription::lost() const {
  const std::lock_guard lock(mutex_);
  return lost_;
}

void Subscription::put(const MessagePtr& message) {
  MessagePtr oldest;  // goes without the lock: it may be large
  {
    const std::lock_guard lock(mutex_);
    if (ended_) return;
    if (messages_.size() == capacity_) {
      oldest = std::move(messages_.front());
      messages_.pop_front();
      ++lost_;
    }
    messages_.push_back(message);
  }
  changed_.notify_one();
}

void Subscription::end() {
  {
    const std::lock_guard lock(mutex_);
    ended_ = true;
  }
  changed_.notify_all();
}

SubscriptionPtr EventStream::subscribe(std::size_t capacity, EventKinds kinds) {
  require(capacity > 0, "a subscription needs room for a message");
  auto subscription = std::make_shared<Subscription>(capacity, kinds);
  const std::lock_guard lock(mutex_);
  if (ended_) subscription->end();
  subscriptions_.push_back(subscription);
  wanted_ = wanted_.load() | kinds;
  return subscription;
}

void EventStream::publish(Event event) {
  if (!wanted_.load(std::memory_order_relaxed).has(event)) return;
  const std::lock_guard lock(mutex_);
  send(std::move(event));
}

void EventStream::publish_change(MapChanged change) {
  const std::lock_guard lock(mutex_);
  ++map_version_;
  if (has_readers_of<MapChanged>()) send(std::move(change));
}

void EventStream::send(Event event) {
  if (ended_) return;
  const auto message =
      std::make_shared<const Message>(Message{++number_, map_version_.load(), std::move(event)});
  bool some_are_gone = false;
  for (const std::weak_ptr<Subscription>& weak : subscriptions_) {
    const SubscriptionPtr subscription = weak.lock();
    some_are_gone = some_are_gone || !subscription;
    if (subscription && subscription->kinds_.has(message->event)) subscription->put(message);
  }
  if (some_are_gone) forget_gone();
}

void EventStream::forget_gone() {
  EventKinds wanted = EventKinds::none();
  const auto is_gone = [&](const std::weak_ptr<Subscription>& weak) {
    const SubscriptionPtr subscription = weak.lock();
    if (subscription) wanted = wanted | subscription->kinds_;
    return !subscription;
  };
  subscriptions_.erase(std::remove_if(subscriptions_.begin(), subscriptions_.end(), is_gone),
                       subscriptions_.end());
  wanted_ = wanted;
}

void EventStream::end() {
  const std::lock_guard lock(mutex_);
  ended_ = true;
  for (const std::weak_ptr<Subscription>& weak : subscriptions_) {
    if (const SubscriptionPtr subscription = weak.lock()) subscription->end();
  }
}

}  // namespace dxslam
