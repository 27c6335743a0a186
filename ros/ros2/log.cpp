// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "ros2/log.h"

#include <rcutils/logging.h>

namespace dxslam::ros2 {

Logger::Logger(const NodeHandle& node) : name_(rcl_node_get_logger_name(node.get())) {}

void Logger::write(int severity, const std::string& sentence) const {
  if (!rcutils_logging_logger_is_enabled_for(name_.c_str(), severity)) return;
  static constexpr rcutils_log_location_t kNowhere{"", "", 0};
  rcutils_log(&kNowhere, severity, name_.c_str(), "%s", sentence.c_str());
}

void Logger::debug(const std::string& sentence) const {
  write(RCUTILS_LOG_SEVERITY_DEBUG, sentence);
}
void Logger::info(const std::string& sentence) const { write(RCUTILS_LOG_SEVERITY_INFO, sentence); }
void Logger::warn(const std::string& sentence) const { write(RCUTILS_LOG_SEVERITY_WARN, sentence); }
void Logger::error(const std::string& sentence) const {
  write(RCUTILS_LOG_SEVERITY_ERROR, sentence);
}

}  // namespace dxslam::ros2
