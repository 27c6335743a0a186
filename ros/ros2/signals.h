// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <functional>
#include <thread>

namespace dxslam::ros2 {

/// While it lives, SIGINT, SIGTERM and SIGHUP call `stop`, in a thread of its own (each time, so
/// that `stop` may be impatient at the second). A signal that was ignored before stays ignored. At
/// most one at a time in a process.
class StopOnSignal {
 public:
  explicit StopOnSignal(std::function<void()> stop);
  ~StopOnSignal();
  StopOnSignal(const StopOnSignal&) = delete;
  StopOnSignal& operator=(const StopOnSignal&) = delete;

 private:
  std::thread thread_;
};

}  // namespace dxslam::ros2
