// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "ros2/given_parameters.h"

#include <rcl/arguments.h>
#include <rcl_yaml_param_parser/parser.h>

#include <cstddef>
#include <memory>
#include <regex>

#include "ros2/error.h"

namespace dxslam::ros2 {
namespace {

bool matches(std::string pattern, const std::string& full_name) {
  if (!pattern.starts_with('/')) pattern.insert(0, "/");
  pattern = std::regex_replace(pattern, std::regex("/\\*\\*"), "(/\\w+)<");
  pattern = std::regex_replace(pattern, std::regex("/\\*"), "(/\\w+)");
  pattern = std::regex_replace(pattern, std::regex("<"), "*");
  try {
    return std::regex_match(full_name, std::regex(pattern));
  } catch (const std::regex_error&) {  // no name of a node
    return false;
  }
}

}  // namespace

std::map<std::string, ParameterValue> given_parameters(const rcl_context_t& context,
                                                       const std::string& full_name) {
  rcl_params_t* all = nullptr;
  check(rcl_arguments_get_param_overrides(&context.global_arguments, &all),
        "the parameters of the command line cannot be read");
  std::map<std::string, ParameterValue> given;
  if (!all) return given;
  const std::unique_ptr<rcl_params_t, decltype(&rcl_yaml_node_struct_fini)> owner(
      all, &rcl_yaml_node_struct_fini);
  for (std::size_t node = 0; node < all->num_nodes; ++node) {
    if (!matches(all->node_names[node], full_name)) continue;
    const rcl_node_params_t& section = all->params[node];
    for (std::size_t i = 0; i < section.num_params; ++i) {
      given[section.parameter_names[i]] = from_variant(section.parameter_values[i]);
    }
  }
  return given;
}

}  // namespace dxslam::ros2
