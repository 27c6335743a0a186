// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "ros2/subscription.h"

#include <rcl/event.h>
#include <rmw/events_statuses/incompatible_qos.h>

#include "ros2/error.h"
#include "ros2/log.h"

namespace dxslam::ros2 {

SubscriptionBase::SubscriptionBase(NodeHandle node, const rosidl_message_type_support_t& type,
                                   const std::string& topic, const Qos& qos)
    : node_(std::move(node)),
      handle_(rcl_get_zero_initialized_subscription()),
      mismatch_(rcl_get_zero_initialized_event()) {
  rcl_subscription_options_t options = rcl_subscription_get_default_options();
  options.qos = qos;
  const rcl_ret_t result =
      rcl_subscription_init(&handle_, node_.get(), &type, topic.c_str(), &options);
  const std::string reason = result == RCL_RET_OK ? "" : take_rcl_error();
  if (rcl_subscription_options_fini(&options) != RCL_RET_OK) take_rcl_error();
  if (result != RCL_RET_OK) throw Error("the topic '" + topic + "' cannot be read: " + reason);
  topic_ = rcl_subscription_get_topic_name(&handle_);
  check(rcl_subscription_event_init(&mismatch_, &handle_,
                                    RCL_SUBSCRIPTION_REQUESTED_INCOMPATIBLE_QOS),
        "the topic '" + topic + "' cannot be watched");
}

SubscriptionBase::~SubscriptionBase() {
  if (rcl_event_fini(&mismatch_) != RCL_RET_OK) take_rcl_error();
  if (rcl_subscription_fini(&handle_, node_.get()) != RCL_RET_OK) take_rcl_error();
}

std::size_t SubscriptionBase::publisher_count() const {
  std::size_t count = 0;
  check(rcl_subscription_get_publisher_count(&handle_, &count),
        "the publishers of " + topic_ + " cannot be counted");
  return count;
}

bool SubscriptionBase::take_any(void* message) {
  rmw_message_info_t info = rmw_get_zero_initialized_message_info();
  const rcl_ret_t result = rcl_take(&handle_, message, &info, nullptr);
  if (result == RCL_RET_SUBSCRIPTION_TAKE_FAILED) return false;
  check(result, "a message of " + topic_ + " cannot be read");
  return true;
}

void SubscriptionBase::count(WaitSizes& sizes) const {
  ++sizes.subscriptions;
  ++sizes.events;
}

void SubscriptionBase::add_to(rcl_wait_set_t& set) {
  check(rcl_wait_set_add_subscription(&set, &handle_, &index_), "cannot wait for " + what());
  check(rcl_wait_set_add_event(&set, &mismatch_, &event_index_), "cannot wait for " + what());
}

bool SubscriptionBase::is_ready(const rcl_wait_set_t& set) const {
  has_message_ = set.subscriptions[index_];
  has_event_ = set.events[event_index_];
  return has_message_ || has_event_;
}

void SubscriptionBase::execute() {
  if (has_event_) report_mismatch();
  if (has_message_) take_and_call();
}

void SubscriptionBase::report_mismatch() {
  rmw_requested_qos_incompatible_event_status_t status{};
  if (rcl_take_event(&mismatch_, &status) != RCL_RET_OK) {
    take_rcl_error();
    return;
  }
  Logger(node_).warn("Somebody publishes " + topic_ +
                     " and is not heard: it offers less than is asked for (" +
                     policy_name(status.last_policy_kind) + ").");
}

std::string SubscriptionBase::what() const { return "the subscription of " + topic_; }

}  // namespace dxslam::ros2
