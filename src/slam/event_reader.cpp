// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "slam/event_reader.h"

#include <fmt/format.h>

#include <chrono>
#include <system_error>
#include <utility>

#include "core/error.h"

namespace dxslam {

EventReader::EventReader(SubscriptionPtr subscription, Function function)
    : subscription_(std::move(subscription)), function_(std::move(function)) {
  require(subscription_ != nullptr && function_ != nullptr,
          "a reader needs a subscription and a function");
  try {
    thread_ = std::thread([this] { read(); });
  } catch (const std::system_error& error) {
    throw InputError(fmt::format("no thread for a reader of events: {}, expected one more",
                                 error.code().message()));
  }
}

EventReader::~EventReader() {
  subscription_->end();
  wait();
}

void EventReader::wait() {
  if (thread_.joinable()) thread_.join();
}

void EventReader::read() {
  while (!subscription_->has_ended()) {
    const MessagePtr message = subscription_->next(std::chrono::hours(1));
    if (message) guard_.call([&] { function_(*message); });
  }
}

}  // namespace dxslam
