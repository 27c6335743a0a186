// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "ros2/subscription.h"

#include "ros2/error.h"
#include "ros2/log.h"

namespace dxslam::ros2 {

SubscriptionBase::SubscriptionBase(NodeHandle node, const rosidl_message_type_support_t& type,
                                   const std::string& topic, const Qos& qos)
    : node_(std::move(node)),
      type_(type),
      asked_topic_(topic),
      qos_(qos),
      may_ask_for_less_(qos.reliability == RMW_QOS_POLICY_RELIABILITY_BEST_AVAILABLE),
      handle_(rcl_get_zero_initialized_subscription()) {
  if (may_ask_for_less_) qos_.reliability = RMW_QOS_POLICY_RELIABILITY_RELIABLE;
  open();
  topic_ = rcl_subscription_get_topic_name(&handle_);
}

SubscriptionBase::~SubscriptionBase() { close(); }

void SubscriptionBase::open() {
  rcl_subscription_options_t options = rcl_subscription_get_default_options();
  options.qos = qos_;
  const rcl_ret_t result =
      rcl_subscription_init(&handle_, node_.get(), &type_, asked_topic_.c_str(), &options);
  const std::string reason = result == RCL_RET_OK ? "" : take_rcl_error();
  if (rcl_subscription_options_fini(&options) != RCL_RET_OK) take_rcl_error();
  if (result != RCL_RET_OK) {
    throw Error("the topic '" + asked_topic_ + "' cannot be read: " + reason);
  }
  mismatch_.emplace(handle_);
}

void SubscriptionBase::close() {
  mismatch_.reset();
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
  mismatch_->count(sizes);
}

void SubscriptionBase::add_to(rcl_wait_set_t& set) {
  check(rcl_wait_set_add_subscription(&set, &handle_, &index_), "cannot wait for " + what());
  mismatch_->add_to(set);
}

bool SubscriptionBase::is_ready(const rcl_wait_set_t& set) const {
  has_message_ = set.subscriptions[index_];
  has_event_ = mismatch_->is_ready(set);
  return has_message_ || has_event_;
}

void SubscriptionBase::execute() {
  // Messages first: meeting a mismatch may drop those that wait.
  if (has_message_) take_and_call();
  if (has_event_) meet_mismatch();
}

void SubscriptionBase::meet_mismatch() {
  const auto policy = mismatch_->take();
  if (!policy) return;
  const Logger log(node_);
  if (*policy != RMW_QOS_POLICY_RELIABILITY || !may_ask_for_less_) {
    log.warn("Somebody publishes " + topic_ +
             " and is not heard: it offers less than is asked for (" + policy_name(*policy) + ").");
    return;
  }
  may_ask_for_less_ = false;
  qos_.reliability = RMW_QOS_POLICY_RELIABILITY_BEST_EFFORT;
  close();
  open();
  log.warn(topic_ + " is published best effort, so messages may be lost; let the publisher be " +
           "reliable if too many are.");
}

std::string SubscriptionBase::what() const { return "the subscription of " + topic_; }

}  // namespace dxslam::ros2
