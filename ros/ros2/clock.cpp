// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "ros2/clock.h"

#include "ros2/error.h"

namespace dxslam::ros2 {
namespace {

constexpr Nanoseconds kSecond = 1'000'000'000;

}  // namespace

Nanoseconds to_nanoseconds(const builtin_interfaces::msg::Time& time) {
  return time.sec * kSecond + time.nanosec;
}

builtin_interfaces::msg::Time to_time(Nanoseconds nanoseconds) {
  Nanoseconds rest = nanoseconds % kSecond;
  if (rest < 0) rest += kSecond;
  builtin_interfaces::msg::Time time;
  time.sec = static_cast<std::int32_t>((nanoseconds - rest) / kSecond);
  time.nanosec = static_cast<std::uint32_t>(rest);
  return time;
}

Clock::Clock() {
  auto clock = std::make_unique<rcl_clock_t>();
  rcl_allocator_t allocator = rcl_get_default_allocator();
  check(rcl_clock_init(RCL_ROS_TIME, clock.get(), &allocator), "a clock cannot be made");
  handle_ = {clock.release(), [](rcl_clock_t* made) {
               if (rcl_clock_fini(made) != RCL_RET_OK) take_rcl_error();
               delete made;
             }};
}

Nanoseconds Clock::now() const {
  rcl_time_point_value_t now = 0;
  check(rcl_clock_get_now(handle_.get(), &now), "the clock cannot be read");
  return now;
}

bool Clock::is_simulated() const {
  bool simulated = false;
  check(rcl_is_enabled_ros_time_override(handle_.get(), &simulated), "the clock cannot be asked");
  return simulated;
}

void Clock::follow_simulation(bool yes) {
  check(yes ? rcl_enable_ros_time_override(handle_.get())
            : rcl_disable_ros_time_override(handle_.get()),
        "the clock cannot be switched");
}

void Clock::set_simulated(Nanoseconds now) {
  check(rcl_set_ros_time_override(handle_.get(), now), "the clock cannot be set");
}

}  // namespace dxslam::ros2
