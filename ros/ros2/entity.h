// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <rcl/node.h>
#include <rcl/wait.h>

#include <cstddef>
#include <memory>
#include <string>

namespace dxslam::ros2 {

/// Shared by all that belongs to one node, which therefore may outlive the Node.
using NodeHandle = std::shared_ptr<rcl_node_t>;

/// How much room a wait set needs.
struct WaitSizes {
  std::size_t subscriptions = 0;
  std::size_t timers = 0;
  std::size_t services = 0;
  std::size_t events = 0;
};

/// Something that an executor waits for and that then calls back. Used by the executor alone.
class Entity {
 public:
  virtual ~Entity() = default;
  Entity(const Entity&) = delete;
  Entity& operator=(const Entity&) = delete;

  virtual void count(WaitSizes& sizes) const = 0;
  virtual void add_to(rcl_wait_set_t& set) = 0;
  /// To be called right after waiting with the set it was added to last.
  virtual bool is_ready(const rcl_wait_set_t& set) const = 0;
  /// Takes what there is, at most one item, and calls back. Throws what the callback throws.
  virtual void execute() = 0;
  /// For messages about it: "the timer", "the subscription of /image".
  virtual std::string what() const = 0;

 protected:
  Entity() = default;
};

}  // namespace dxslam::ros2
