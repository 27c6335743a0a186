// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <rcl/timer.h>

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>

#include "ros2/entity.h"

namespace dxslam::ros2 {

/// Calls back again and again. Made by Node. After a delay it calls once, not once per period
/// missed.
class Timer final : public Entity {
 public:
  using Callback = std::function<void()>;

  /// By `clock`, which may be simulated.
  Timer(std::shared_ptr<rcl_context_t> context, std::shared_ptr<rcl_clock_t> clock,
        std::chrono::nanoseconds period, Callback callback);
  ~Timer() override;

  void count(WaitSizes& sizes) const override;
  void add_to(rcl_wait_set_t& set) override;
  bool is_ready(const rcl_wait_set_t& set) const override;
  void execute() override;
  std::string what() const override;

 private:
  std::shared_ptr<rcl_context_t> context_;
  std::shared_ptr<rcl_clock_t> clock_;
  rcl_timer_t handle_;
  std::size_t index_ = 0;
  Callback callback_;
};

/// The computer's steady clock, which never jumps.
std::shared_ptr<rcl_clock_t> steady_clock();

}  // namespace dxslam::ros2
