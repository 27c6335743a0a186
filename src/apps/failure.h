// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <exception>
#include <string>

namespace dxslam::apps {

/// How a command tells an exception.
struct Failure {
  std::string sentence;
  int code = 0;  ///< kBadInput, or kInternalError: always a bug
};

/// Missing memory, a system that gives no more, and files that cannot be reached are no bugs.
Failure failure_of(const std::exception& error);
/// Of the exception that is being handled.
Failure current_failure();

}  // namespace dxslam::apps
