// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstdint>
#include <functional>
#include <thread>

#include "slam/callback_guard.h"
#include "slam/event_stream.h"

namespace dxslam {

/// A thread that calls a function with every message of a subscription, in order:
///
///   EventReader reader(system.subscribe(), [](const Message& message) { ... });
///
/// What the function throws costs that message alone, and is counted. The function must not destroy
/// the reader. Any thread may call any member, but only one wait().
class EventReader {
 public:
  using Function = std::function<void(const Message&)>;

  /// Throws InputError where the operating system gives no thread.
  EventReader(SubscriptionPtr subscription, Function function);
  /// Reads what has come so far, and ends the subscription.
  ~EventReader();
  EventReader(const EventReader&) = delete;
  EventReader& operator=(const EventReader&) = delete;

  /// Waits until the stream has ended (System::finish()) and all was read. Further calls do
  /// nothing.
  void wait();
  CallbackFailures failures() const { return guard_.failures(); }
  /// Messages lost, because they were read too slowly.
  std::uint64_t lost() const { return subscription_->lost(); }

 private:
  void read();

  const SubscriptionPtr subscription_;
  const Function function_;
  CallbackGuard guard_;
  std::thread thread_;
};

}  // namespace dxslam
