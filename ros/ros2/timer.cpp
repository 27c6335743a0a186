// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "ros2/timer.h"

#include <utility>

#include "ros2/error.h"

namespace dxslam::ros2 {

std::shared_ptr<rcl_clock_t> steady_clock() {
  auto clock = std::make_unique<rcl_clock_t>();
  rcl_allocator_t allocator = rcl_get_default_allocator();
  check(rcl_clock_init(RCL_STEADY_TIME, clock.get(), &allocator), "a clock cannot be made");
  return {clock.release(), [](rcl_clock_t* made) {
            if (rcl_clock_fini(made) != RCL_RET_OK) take_rcl_error();
            delete made;
          }};
}

Timer::Timer(std::shared_ptr<rcl_context_t> context, std::shared_ptr<rcl_clock_t> clock,
             std::chrono::nanoseconds period, Callback callback)
    : context_(std::move(context)),
      clock_(std::move(clock)),
      handle_(rcl_get_zero_initialized_timer()),
      callback_(std::move(callback)) {
  check(rcl_timer_init2(&handle_, clock_.get(), context_.get(), period.count(), nullptr,
                        rcl_get_default_allocator(), true),
        "a timer cannot be made");
}

Timer::~Timer() {
  if (rcl_timer_fini(&handle_) != RCL_RET_OK) take_rcl_error();
}

void Timer::count(WaitSizes& sizes) const { ++sizes.timers; }

void Timer::add_to(rcl_wait_set_t& set) {
  check(rcl_wait_set_add_timer(&set, &handle_, &index_), "cannot wait for a timer");
}

bool Timer::is_ready(const rcl_wait_set_t& set) const { return set.timers[index_]; }

void Timer::execute() {
  check(rcl_timer_call(&handle_), "a timer cannot be wound up again");
  callback_();
}

std::string Timer::what() const { return "a timer"; }

}  // namespace dxslam::ros2
