// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "ros2/qos_mismatch.h"

#include <rmw/events_statuses/incompatible_qos.h>

#include "ros2/error.h"

namespace dxslam::ros2 {

QosMismatch::QosMismatch(const rcl_publisher_t& publisher)
    : handle_(rcl_get_zero_initialized_event()) {
  accept(rcl_publisher_event_init(&handle_, &publisher, RCL_PUBLISHER_OFFERED_INCOMPATIBLE_QOS));
}

QosMismatch::QosMismatch(const rcl_subscription_t& subscription)
    : handle_(rcl_get_zero_initialized_event()) {
  accept(rcl_subscription_event_init(&handle_, &subscription,
                                     RCL_SUBSCRIPTION_REQUESTED_INCOMPATIBLE_QOS));
}

void QosMismatch::accept(rcl_ret_t result) {
  if (result == RCL_RET_UNSUPPORTED) {
    take_rcl_error();
    is_supported_ = false;
    return;
  }
  check(result, "the other ends of a topic cannot be watched");
}

QosMismatch::~QosMismatch() {
  if (is_supported_ && rcl_event_fini(&handle_) != RCL_RET_OK) take_rcl_error();
}

void QosMismatch::count(WaitSizes& sizes) const { sizes.events += is_supported_ ? 1 : 0; }

void QosMismatch::add_to(rcl_wait_set_t& set) {
  if (is_supported_) {
    check(rcl_wait_set_add_event(&set, &handle_, &index_), "cannot wait for the ends of a topic");
  }
}

bool QosMismatch::is_ready(const rcl_wait_set_t& set) const {
  return is_supported_ && set.events[index_];
}

std::optional<rmw_qos_policy_kind_t> QosMismatch::take() {
  rmw_qos_incompatible_event_status_t status{};
  if (rcl_take_event(&handle_, &status) != RCL_RET_OK) {
    take_rcl_error();
    return std::nullopt;
  }
  return status.last_policy_kind;
}

std::string policy_name(rmw_qos_policy_kind_t kind) {
  switch (kind) {
    case RMW_QOS_POLICY_RELIABILITY:
      return "reliability";
    case RMW_QOS_POLICY_DURABILITY:
      return "durability";
    case RMW_QOS_POLICY_DEADLINE:
      return "deadline";
    case RMW_QOS_POLICY_LIVELINESS:
      return "liveliness";
    default:
      return "quality of service";
  }
}

}  // namespace dxslam::ros2
