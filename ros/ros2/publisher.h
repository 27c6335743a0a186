// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <rcl/publisher.h>

#include <cstddef>
#include <optional>
#include <string>
#include <utility>

#include "ros2/entity.h"
#include "ros2/qos.h"
#include "ros2/qos_mismatch.h"
#include "ros2/type_support.h"

namespace dxslam::ros2 {

/// What Publisher is without the type of its messages. Made by Node. As an entity it only says in
/// the log that somebody asks for more than it offers.
class PublisherBase : public Entity {
 public:
  PublisherBase(NodeHandle node, const rosidl_message_type_support_t& type,
                const std::string& topic, const Qos& qos);
  ~PublisherBase() override;

  /// The full name, after remapping.
  const std::string& topic() const { return topic_; }
  /// How many subscriptions it reaches now. Any thread.
  std::size_t subscriber_count() const;

  void count(WaitSizes& sizes) const override;
  void add_to(rcl_wait_set_t& set) override;
  bool is_ready(const rcl_wait_set_t& set) const override;
  void execute() override;
  std::string what() const override;

 protected:
  void publish_any(const void* message);

 private:
  NodeHandle node_;
  rcl_publisher_t handle_;
  std::optional<QosMismatch> mismatch_;
  std::string topic_;
};

template <class Message>
class Publisher final : public PublisherBase {
 public:
  Publisher(NodeHandle node, const std::string& topic, const Qos& qos)
      : PublisherBase(std::move(node), message_type<Message>(), topic, qos) {}

  /// Any thread. Returns as soon as the middleware has the message.
  void publish(const Message& message) { publish_any(&message); }
};

}  // namespace dxslam::ros2
