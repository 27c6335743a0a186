// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <rcl/types.h>

#include <stdexcept>
#include <string>

namespace dxslam::ros2 {

/// What ROS 2 refuses or cannot do: a name, a parameter, a middleware. One sentence for people.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Throws Error with `what` and rcl's own words unless `result` is RCL_RET_OK. Clears rcl's error.
void check(rcl_ret_t result, const std::string& what);

/// rcl's words about its last error, which it clears; for destructors and the like.
std::string take_rcl_error();

}  // namespace dxslam::ros2
