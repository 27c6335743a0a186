// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "ros2/parameters.h"

#include <cmath>
#include <cstddef>

#include "ros2/error.h"
#include "ros2/given_parameters.h"
#include "ros2/node.h"
#include "ros2/parameter_services.h"

namespace dxslam::ros2 {
namespace {

template <class Number>
Refusal outside(const std::string& name, Number value, const ParameterRange<Number>& range) {
  const ParameterValue from = range.from;
  const ParameterValue to = range.to;
  const std::string limits = to_string(from) + " to " + to_string(to);
  if (!(value >= range.from && value <= range.to)) {
    return name + " is " + limits + ", not " + to_string(ParameterValue(value)) + ".";
  }
  if (range.step == Number{} || value == range.to) return std::nullopt;
  const double steps = (static_cast<double>(value) - static_cast<double>(range.from)) /
                       static_cast<double>(range.step);
  if (std::abs(steps - std::round(steps)) < 1e-9 * (1.0 + std::abs(steps))) return std::nullopt;
  return name + " is " + limits + " in steps of " + to_string(ParameterValue(range.step)) +
         ", not " + to_string(ParameterValue(value)) + ".";
}

/// Whether `value` may be that of the parameter, which is of the type of `like`; makes a number of
/// a whole number where one is expected.
Refusal fit(const ParameterInfo& info, const ParameterValue& like, ParameterValue& value) {
  if (const auto* whole = std::get_if<std::int64_t>(&value);
      whole && std::holds_alternative<double>(like)) {
    value = static_cast<double>(*whole);
  }
  if (const auto* wholes = std::get_if<std::vector<std::int64_t>>(&value);
      wholes && std::holds_alternative<std::vector<double>>(like)) {
    value = std::vector<double>(wholes->begin(), wholes->end());
  }
  if (value.index() != like.index()) {
    return info.name + " is " + std::string(type_name(like)) + ", not " +
           std::string(type_name(value)) + ".";
  }
  if (const auto* whole = std::get_if<std::int64_t>(&value); whole && info.integer_range) {
    if (auto why = outside(info.name, *whole, *info.integer_range)) return why;
  }
  if (const auto* number = std::get_if<double>(&value); number && info.number_range) {
    if (auto why = outside(info.name, *number, *info.number_range)) return why;
  }
  return info.check ? info.check(value) : std::nullopt;
}

}  // namespace

Parameters::Parameters(Node& node, const Context& context)
    : node_(node),
      given_(given_parameters(*context.handle(), node.full_name())),
      events_(node.create_publisher<rcl_interfaces::msg::ParameterEvent>(
          "/parameter_events", rmw_qos_profile_parameter_events)),
      services_(std::make_unique<ParameterServices>(node, *this)) {}

Parameters::~Parameters() = default;

ParameterValue Parameters::declare_value(const ParameterInfo& info,
                                         const ParameterValue& otherwise) {
  if (has(info.name)) throw Error("the parameter " + info.name + " is declared twice");
  ParameterValue value = otherwise;
  const auto given = given_.find(info.name);
  if (given != given_.end()) {
    value = given->second;
    if (const Refusal why = fit(info, otherwise, value)) throw Error(*why);
  }
  {
    const std::lock_guard lock(mutex_);
    declared_[info.name] = {info, value};
  }
  tell({{info.name, value}}, true);
  return value;
}

ParameterValue Parameters::get_value(const std::string& name) const {
  const std::lock_guard lock(mutex_);
  const auto found = declared_.find(name);
  if (found == declared_.end()) throw Error("there is no parameter " + name);
  return found->second.value;
}

Refusal Parameters::prepare(const Change& change, std::vector<Change>& accepted) const {
  const auto found = declared_.find(change.first);
  if (found == declared_.end()) return "There is no parameter " + change.first + ".";
  const auto& [info, present] = found->second;
  if (info.read_only) return info.name + " can be given at the start of the node alone.";
  ParameterValue value = change.second;
  if (auto why = fit(info, present, value)) return why;
  accepted.emplace_back(change.first, std::move(value));
  return std::nullopt;
}

Refusal Parameters::set(const std::vector<Change>& changes) {
  std::vector<Change> accepted;
  for (const Change& change : changes) {
    if (auto why = prepare(change, accepted)) return why;
  }
  for (const GroupCheck& check : group_checks_) {
    if (auto why = check(accepted)) return why;
  }
  std::vector<Change> changed;
  {
    const std::lock_guard lock(mutex_);
    for (const Change& change : accepted) {
      ParameterValue& present = declared_.at(change.first).value;
      if (present != change.second) changed.push_back(change);
      present = change.second;
    }
  }
  tell(accepted, false);
  for (const auto& [name, value] : changed) {
    for (const Listener& listener : listeners_) listener(name, value);
  }
  return std::nullopt;
}

void Parameters::tell(const std::vector<Change>& changes, bool are_new) {
  if (changes.empty()) return;
  rcl_interfaces::msg::ParameterEvent event;
  event.stamp = to_time(node_.clock().now());
  event.node = node_.full_name();
  auto& list = are_new ? event.new_parameters : event.changed_parameters;
  for (const auto& [name, value] : changes) {
    auto& parameter = list.emplace_back();
    parameter.name = name;
    parameter.value = to_message(value);
  }
  events_->publish(event);
}

std::vector<std::string> Parameters::undeclared() const {
  std::vector<std::string> names;
  for (const auto& [name, value] : given_) {
    if (!has(name)) names.push_back(name);
  }
  return names;
}

bool Parameters::has(const std::string& name) const {
  const std::lock_guard lock(mutex_);
  return declared_.contains(name);
}

std::vector<std::string> Parameters::names() const {
  const std::lock_guard lock(mutex_);
  std::vector<std::string> names;
  for (const auto& [name, parameter] : declared_) names.push_back(name);
  return names;
}

rcl_interfaces::msg::ParameterDescriptor Parameters::describe(const std::string& name) const {
  rcl_interfaces::msg::ParameterDescriptor description;
  description.name = name;
  const std::lock_guard lock(mutex_);
  const auto found = declared_.find(name);
  if (found == declared_.end()) return description;
  const auto& [info, value] = found->second;
  description.type = type_of(value);
  description.description = info.description;
  description.additional_constraints = info.constraints;
  description.read_only = info.read_only;
  if (const auto& range = info.integer_range) {
    auto& limits = description.integer_range.emplace_back();
    limits.from_value = range->from;
    limits.to_value = range->to;
    limits.step = static_cast<std::uint64_t>(range->step);
  }
  if (const auto& range = info.number_range) {
    auto& limits = description.floating_point_range.emplace_back();
    limits.from_value = range->from;
    limits.to_value = range->to;
    limits.step = range->step;
  }
  return description;
}

}  // namespace dxslam::ros2
