// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <string>

#include "ros2/entity.h"

namespace dxslam::ros2 {

/// A node's log: stderr, ROS's log file and the topic /rosout. Any thread.
class Logger {
 public:
  explicit Logger(const NodeHandle& node);

  void debug(const std::string& sentence) const;
  void info(const std::string& sentence) const;
  void warn(const std::string& sentence) const;
  void error(const std::string& sentence) const;

 private:
  void write(int severity, const std::string& sentence) const;

  std::string name_;
};

}  // namespace dxslam::ros2
