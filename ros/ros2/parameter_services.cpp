// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "ros2/parameter_services.h"

#include <algorithm>
#include <rcl_interfaces/msg/set_parameters_result.hpp>
#include <rcl_interfaces/srv/describe_parameters.hpp>
#include <rcl_interfaces/srv/get_parameter_types.hpp>
#include <rcl_interfaces/srv/get_parameters.hpp>
#include <rcl_interfaces/srv/list_parameters.hpp>
#include <rcl_interfaces/srv/set_parameters.hpp>
#include <rcl_interfaces/srv/set_parameters_atomically.hpp>
#include <set>
#include <string>

#include "ros2/node.h"
#include "ros2/parameters.h"

namespace dxslam::ros2 {
namespace {

namespace srv = rcl_interfaces::srv;

rcl_interfaces::msg::SetParametersResult to_result(const Refusal& why) {
  rcl_interfaces::msg::SetParametersResult result;
  result.successful = !why;
  result.reason = why.value_or("");
  return result;
}

Parameters::Change to_change(const rcl_interfaces::msg::Parameter& parameter) {
  return {parameter.name, from_message(parameter.value)};
}

ParameterValue value_or_none(const Parameters& parameters, const std::string& name) {
  return parameters.has(name) ? parameters.get_value(name) : ParameterValue();
}

/// Names below one of the prefixes (all, if there are none), at most `depth` parts deeper (0: any).
void list(const Parameters& parameters, const srv::ListParameters::Request& request,
          srv::ListParameters::Response& response) {
  const auto dots = [](std::string_view text) {
    return static_cast<std::uint64_t>(std::ranges::count(text, '.'));
  };
  std::set<std::string> prefixes;
  for (const std::string& name : parameters.names()) {
    const auto is_below = [&](const std::string& prefix) {
      if (name == prefix) return true;
      if (!name.starts_with(prefix + ".")) return false;
      return request.depth == 0 || dots(name) - dots(prefix) <= request.depth;
    };
    const bool wanted = request.prefixes.empty() ? request.depth == 0 || dots(name) < request.depth
                                                 : std::ranges::any_of(request.prefixes, is_below);
    if (!wanted) continue;
    response.result.names.push_back(name);
    const auto last = name.rfind('.');
    if (last != std::string::npos) prefixes.insert(name.substr(0, last));
  }
  response.result.prefixes.assign(prefixes.begin(), prefixes.end());
}

}  // namespace

ParameterServices::ParameterServices(Node& node, Parameters& parameters) {
  const auto offer = [&]<class Type>(const char* name, typename Service<Type>::Callback callback) {
    services_.push_back(
        node.create_service<Type>(name, std::move(callback), rmw_qos_profile_parameters));
  };
  offer.operator()<srv::DescribeParameters>(
      "~/describe_parameters", [&parameters](const auto& request, auto& response) {
        for (const auto& name : request.names) {
          response.descriptors.push_back(parameters.describe(name));
        }
      });
  offer.operator()<srv::GetParameters>(
      "~/get_parameters", [&parameters](const auto& request, auto& response) {
        for (const auto& name : request.names) {
          response.values.push_back(to_message(value_or_none(parameters, name)));
        }
      });
  offer.operator()<srv::GetParameterTypes>(
      "~/get_parameter_types", [&parameters](const auto& request, auto& response) {
        for (const auto& name : request.names) {
          response.types.push_back(type_of(value_or_none(parameters, name)));
        }
      });
  offer.operator()<srv::ListParameters>(
      "~/list_parameters",
      [&parameters](const auto& request, auto& response) { list(parameters, request, response); });
  offer.operator()<srv::SetParameters>(
      "~/set_parameters", [&parameters](const auto& request, auto& response) {
        for (const auto& parameter : request.parameters) {
          response.results.push_back(to_result(parameters.set({to_change(parameter)})));
        }
      });
  offer.operator()<srv::SetParametersAtomically>(
      "~/set_parameters_atomically", [&parameters](const auto& request, auto& response) {
        std::vector<Parameters::Change> changes;
        for (const auto& parameter : request.parameters) changes.push_back(to_change(parameter));
        response.result = to_result(parameters.set(changes));
      });
}

}  // namespace dxslam::ros2
