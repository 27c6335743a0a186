// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "ros2/error.h"

#include <rcl/error_handling.h>

namespace dxslam::ros2 {

std::string take_rcl_error() {
  // rcl's text ends in ", at file.c:123" of the machine that built it.
  std::string text = rcl_get_error_string().str;
  rcl_reset_error();
  return text.substr(0, text.find(", at /"));
}

void check(rcl_ret_t result, const std::string& what) {
  if (result == RCL_RET_OK) return;
  throw Error(what + ": " + take_rcl_error());
}

}  // namespace dxslam::ros2
