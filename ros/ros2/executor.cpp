// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "ros2/executor.h"

#include <rcl/error_handling.h>

#include <exception>
#include <utility>

#include "ros2/entity.h"
#include "ros2/error.h"
#include "ros2/node.h"

namespace dxslam::ros2 {
namespace {

void call(const Node* node, const std::string& what, const std::function<void()>& callback) {
  try {
    callback();
  } catch (const std::exception& error) {
    if (node) node->log().error("An error in " + what + ": " + error.what());
  }
}

}  // namespace

Executor::Executor(const Context& context)
    : context_(context.handle()),
      set_(rcl_get_zero_initialized_wait_set()),
      wake_(rcl_get_zero_initialized_guard_condition()) {
  check(rcl_guard_condition_init(&wake_, context_.get(), rcl_guard_condition_get_default_options()),
        "an executor cannot be made");
  if (rcl_wait_set_init(&set_, 0, 1, 0, 0, 0, 0, context_.get(), rcl_get_default_allocator()) !=
      RCL_RET_OK) {
    const std::string reason = take_rcl_error();
    if (rcl_guard_condition_fini(&wake_) != RCL_RET_OK) take_rcl_error();
    throw Error("an executor cannot be made: " + reason);
  }
}

Executor::~Executor() {
  if (rcl_wait_set_fini(&set_) != RCL_RET_OK) take_rcl_error();
  if (rcl_guard_condition_fini(&wake_) != RCL_RET_OK) take_rcl_error();
}

void Executor::add(Node& node) { nodes_.push_back(&node); }

void Executor::spin() {
  while (spin_once(std::chrono::hours(1))) {
  }
}

bool Executor::spin_once(std::chrono::nanoseconds timeout) {
  std::vector<std::shared_ptr<Entity>> entities;
  std::vector<Node*> owners;
  for (Node* node : nodes_) {
    for (auto& entity : node->entities()) {
      entities.push_back(std::move(entity));
      owners.push_back(node);
    }
  }
  if (stopped_) return false;
  wait(entities, timeout);
  // The set is filled anew by a callback that spins, so look at all of it first.
  std::vector<bool> ready(entities.size());
  for (std::size_t i = 0; i < entities.size(); ++i) ready[i] = entities[i]->is_ready(set_);
  run_tasks();
  for (std::size_t i = 0; i < entities.size() && !stopped_; ++i) {
    if (!ready[i] || entities[i].use_count() == 1) continue;  // its owner has dropped it
    call(owners[i], entities[i]->what(), [&] { entities[i]->execute(); });
  }
  return !stopped_;
}

void Executor::wait(const std::vector<std::shared_ptr<Entity>>& entities,
                    std::chrono::nanoseconds timeout) {
  WaitSizes sizes;
  for (const auto& entity : entities) entity->count(sizes);
  check(rcl_wait_set_resize(&set_, sizes.subscriptions, 1, sizes.timers, 0, sizes.services,
                            sizes.events),
        "an executor cannot wait");
  check(rcl_wait_set_clear(&set_), "an executor cannot wait");
  check(rcl_wait_set_add_guard_condition(&set_, &wake_, nullptr), "an executor cannot wait");
  for (const auto& entity : entities) entity->add_to(set_);
  const rcl_ret_t result = rcl_wait(&set_, timeout.count());
  if (result != RCL_RET_TIMEOUT) check(result, "an executor cannot wait");
}

void Executor::run_tasks() {
  std::vector<std::function<void()>> tasks;
  {
    const std::lock_guard lock(mutex_);
    tasks.swap(tasks_);
  }
  for (const auto& task : tasks) {
    if (stopped_) return;
    call(nodes_.empty() ? nullptr : nodes_.front(), "a task", task);
  }
}

void Executor::post(std::function<void()> task) {
  {
    const std::lock_guard lock(mutex_);
    tasks_.push_back(std::move(task));
  }
  wake();
}

void Executor::stop() noexcept {
  stopped_ = true;
  wake();
}

void Executor::wake() noexcept {
  if (rcl_trigger_guard_condition(&wake_) != RCL_RET_OK) rcl_reset_error();
}

}  // namespace dxslam::ros2
