// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <rcl/context.h>

#include <memory>
#include <string>
#include <vector>

namespace dxslam::ros2 {

/// A process's membership in ROS 2: what the command line and the environment (ROS_DOMAIN_ID,
/// RMW_..., ROS_LOG_DIR) say about it, and its logging. Make one, before all nodes. All that is
/// made with it keeps it alive, so the order of destruction is free.
class Context {
 public:
  /// Reads everything between `--ros-args` and `--`: remappings (-r), parameters (-p,
  /// --params-file), the level of logging. Throws Error where something there cannot be read.
  Context(int argc, const char* const* argv);

  /// The command line without the program's name and without what was for ROS.
  const std::vector<std::string>& arguments() const { return arguments_; }

  /// Never null; shared by all that need it.
  const std::shared_ptr<rcl_context_t>& handle() const { return handle_; }

 private:
  std::shared_ptr<rcl_context_t> handle_;
  std::vector<std::string> arguments_;
};

}  // namespace dxslam::ros2
