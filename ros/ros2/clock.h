// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <rcl/time.h>

#include <builtin_interfaces/msg/time.hpp>
#include <cstdint>
#include <memory>

namespace dxslam::ros2 {

/// Nanoseconds since 1970, or since the start of a simulation.
using Nanoseconds = std::int64_t;

Nanoseconds to_nanoseconds(const builtin_interfaces::msg::Time& time);
builtin_interfaces::msg::Time to_time(Nanoseconds nanoseconds);

/// The time that messages carry: the computer's, or what somebody publishes on /clock where the
/// node's parameter use_sim_time is true (0 until the first such message).
class Clock {
 public:
  Clock();

  /// Any thread.
  Nanoseconds now() const;
  bool is_simulated() const;

  // For Node alone, in the executor's thread.
  void follow_simulation(bool yes);
  void set_simulated(Nanoseconds now);

  const std::shared_ptr<rcl_clock_t>& handle() const { return handle_; }

 private:
  std::shared_ptr<rcl_clock_t> handle_;
};

}  // namespace dxslam::ros2
