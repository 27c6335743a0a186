// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <rcl_yaml_param_parser/types.h>

#include <cstdint>
#include <rcl_interfaces/msg/parameter_value.hpp>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace dxslam::ros2 {

/// Of a parameter. The order is that of ROS's own numbers of types, from NOT_SET.
using ParameterValue =
    std::variant<std::monostate, bool, std::int64_t, double, std::string, std::vector<std::uint8_t>,
                 std::vector<bool>, std::vector<std::int64_t>, std::vector<double>,
                 std::vector<std::string>>;

/// rcl_interfaces/ParameterType.
inline std::uint8_t type_of(const ParameterValue& value) {
  return static_cast<std::uint8_t>(value.index());
}

/// For people, with an article: "a number", "a list of texts".
std::string_view type_name(const ParameterValue& value);

/// For people: 0.5, 'text', [1, 2].
std::string to_string(const ParameterValue& value);

rcl_interfaces::msg::ParameterValue to_message(const ParameterValue& value);
/// Not set where the message's type is none that exists.
ParameterValue from_message(const rcl_interfaces::msg::ParameterValue& message);
/// Of what a command line or a file says.
ParameterValue from_variant(const rcl_variant_t& variant);

}  // namespace dxslam::ros2
