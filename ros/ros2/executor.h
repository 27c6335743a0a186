// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <rcl/guard_condition.h>
#include <rcl/wait.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <vector>

#include "ros2/context.h"

namespace dxslam::ros2 {

class Entity;
class Node;

/// Waits for messages, requests and timers of nodes and calls back, all in the one thread that
/// spins. What a callback throws is logged as an error of that node and costs nothing else.
class Executor {
 public:
  explicit Executor(const Context& context);
  ~Executor();
  Executor(const Executor&) = delete;
  Executor& operator=(const Executor&) = delete;

  /// Before spinning. The node must outlive the executor's last spin.
  void add(Node& node);

  /// Until stop().
  void spin();
  /// Waits at most `timeout` for something to do, and does all that is ready then. Returns false
  /// where stop() was called.
  bool spin_once(std::chrono::nanoseconds timeout);

  /// Any thread. Spinning ends after the callback that runs. Nothing is done after it.
  void stop() noexcept;
  /// Any thread: `task` will be called by the thread that spins, tasks in the order of posting.
  void post(std::function<void()> task);

 private:
  void wait(const std::vector<std::shared_ptr<Entity>>& entities, std::chrono::nanoseconds timeout);
  void run_tasks();
  void wake() noexcept;

  std::shared_ptr<rcl_context_t> context_;
  std::vector<Node*> nodes_;
  rcl_wait_set_t set_;
  rcl_guard_condition_t wake_;
  std::atomic<bool> stopped_ = false;
  std::mutex mutex_;
  std::vector<std::function<void()>> tasks_;  ///< guarded by mutex_
};

}  // namespace dxslam::ros2
