// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <rcl/context.h>

#include <map>
#include <string>

#include "ros2/parameter_value.h"

namespace dxslam::ros2 {

/// What the command line (-p, --params-file) says to the node of that full name. Sections of a file
/// name nodes, also by patterns: "/**" any, "/*" one level. What comes later wins.
std::map<std::string, ParameterValue> given_parameters(const rcl_context_t& context,
                                                       const std::string& full_name);

}  // namespace dxslam::ros2
