// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <rcl/subscription.h>

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "ros2/entity.h"
#include "ros2/qos.h"
#include "ros2/qos_mismatch.h"
#include "ros2/type_support.h"

namespace dxslam::ros2 {

/// What Subscription is without the type of its messages. Made by Node. Where a publisher offers
/// less than is asked for, the log says so, or, with camera_data(), less is asked for.
class SubscriptionBase : public Entity {
 public:
  SubscriptionBase(NodeHandle node, const rosidl_message_type_support_t& type,
                   const std::string& topic, const Qos& qos);
  ~SubscriptionBase() override;

  /// The full name, after remapping.
  const std::string& topic() const { return topic_; }
  /// How many publishers reach it now. In the executor's thread.
  std::size_t publisher_count() const;

  void count(WaitSizes& sizes) const override;
  void add_to(rcl_wait_set_t& set) override;
  bool is_ready(const rcl_wait_set_t& set) const override;
  void execute() override;
  std::string what() const override;

 protected:
  /// Into `message`; whether there was one.
  bool take_any(void* message);
  virtual void take_and_call() = 0;

 private:
  void open();
  void close();
  void meet_mismatch();

  NodeHandle node_;
  const rosidl_message_type_support_t& type_;
  std::string asked_topic_;
  Qos qos_;
  bool may_ask_for_less_ = false;
  rcl_subscription_t handle_;
  std::optional<QosMismatch> mismatch_;
  std::size_t index_ = 0;
  mutable bool has_message_ = false;
  mutable bool has_event_ = false;
  std::string topic_;
};

template <class Message>
class Subscription final : public SubscriptionBase {
 public:
  /// Called in the executor's thread; the message may be kept.
  using Callback = std::function<void(std::shared_ptr<const Message>)>;

  Subscription(NodeHandle node, const std::string& topic, const Qos& qos, Callback callback)
      : SubscriptionBase(std::move(node), message_type<Message>(), topic, qos),
        callback_(std::move(callback)) {}

 private:
  void take_and_call() override {
    auto message = std::make_shared<Message>();
    if (take_any(message.get())) callback_(std::move(message));
  }

  Callback callback_;
};

}  // namespace dxslam::ros2
