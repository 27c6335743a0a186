// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "ros2/publisher.h"

#include <utility>

#include "ros2/error.h"
#include "ros2/log.h"

namespace dxslam::ros2 {

PublisherBase::PublisherBase(NodeHandle node, const rosidl_message_type_support_t& type,
                             const std::string& topic, const Qos& qos)
    : node_(std::move(node)), handle_(rcl_get_zero_initialized_publisher()) {
  rcl_publisher_options_t options = rcl_publisher_get_default_options();
  options.qos = qos;
  check(rcl_publisher_init(&handle_, node_.get(), &type, topic.c_str(), &options),
        "the topic '" + topic + "' cannot be published");
  topic_ = rcl_publisher_get_topic_name(&handle_);
  mismatch_.emplace(handle_);
}

PublisherBase::~PublisherBase() {
  mismatch_.reset();
  if (rcl_publisher_fini(&handle_, node_.get()) != RCL_RET_OK) take_rcl_error();
}

std::size_t PublisherBase::subscriber_count() const {
  std::size_t count = 0;
  check(rcl_publisher_get_subscription_count(&handle_, &count),
        "the subscribers of " + topic_ + " cannot be counted");
  return count;
}

void PublisherBase::publish_any(const void* message) {
  check(rcl_publish(&handle_, message, nullptr), "a message cannot be published on " + topic_);
}

void PublisherBase::count(WaitSizes& sizes) const { mismatch_->count(sizes); }

void PublisherBase::add_to(rcl_wait_set_t& set) { mismatch_->add_to(set); }

bool PublisherBase::is_ready(const rcl_wait_set_t& set) const { return mismatch_->is_ready(set); }

void PublisherBase::execute() {
  if (const auto policy = mismatch_->take()) {
    Logger(node_).warn("Somebody reads " + topic_ +
                       " and gets nothing: it asks for more than is offered (" +
                       policy_name(*policy) + ").");
  }
}

std::string PublisherBase::what() const { return "the publisher of " + topic_; }

}  // namespace dxslam::ros2
