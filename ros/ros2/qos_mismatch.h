// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <rcl/event.h>
#include <rcl/wait.h>
#include <rmw/qos_policy_kind.h>

#include <cstddef>
#include <optional>
#include <string>

#include "ros2/entity.h"

namespace dxslam::ros2 {

/// Tells that the other end of a topic was found and does not fit. Says nothing with a middleware
/// that cannot tell.
class QosMismatch {
 public:
  /// The handle must outlive it.
  explicit QosMismatch(const rcl_publisher_t& publisher);
  explicit QosMismatch(const rcl_subscription_t& subscription);
  ~QosMismatch();
  QosMismatch(const QosMismatch&) = delete;
  QosMismatch& operator=(const QosMismatch&) = delete;

  void count(WaitSizes& sizes) const;
  void add_to(rcl_wait_set_t& set);
  bool is_ready(const rcl_wait_set_t& set) const;
  /// Of which policy the last ones found ask or offer too much or too little.
  std::optional<rmw_qos_policy_kind_t> take();

 private:
  void accept(rcl_ret_t result);

  rcl_event_t handle_;
  bool is_supported_ = true;
  std::size_t index_ = 0;
};

/// "reliability", "durability" and so on.
std::string policy_name(rmw_qos_policy_kind_t kind);

}  // namespace dxslam::ros2
