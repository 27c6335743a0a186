// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <rcl_interfaces/msg/parameter_descriptor.hpp>
#include <rcl_interfaces/msg/parameter_event.hpp>
#include <string>
#include <utility>
#include <vector>

#include "ros2/context.h"
#include "ros2/parameter_value.h"

namespace dxslam::ros2 {

class Node;
class ParameterServices;
template <class Message>
class Publisher;

/// Numbers from `from` to `to`, in steps of `step` (0: any).
template <class Number>
struct ParameterRange {
  Number from{};
  Number to{};
  Number step{};
};

/// Why a value is refused: one sentence.
using Refusal = std::optional<std::string>;

/// What people are told about a parameter, and what it may be.
struct ParameterInfo {
  std::string name;  ///< parts joined by dots
  std::string description{};
  std::string constraints{};  ///< what `check` demands, in words
  bool read_only = false;     ///< can be given at the start alone
  std::optional<ParameterRange<std::int64_t>> integer_range{};
  std::optional<ParameterRange<double>> number_range{};
  std::function<Refusal(const ParameterValue&)> check{};  ///< after type and range; may be empty
};

/// The parameters of a node, with the six services of ROS 2 and /parameter_events. Reading: any
/// thread; all else in the executor's thread. A parameter keeps the type of its default. A
/// whole number is taken where a number is expected; every other type is refused.
class Parameters {
 public:
  using Change = std::pair<std::string, ParameterValue>;
  /// Sees all new values of one request together. Throwing nothing, it may refuse them all.
  using GroupCheck = std::function<Refusal(const std::vector<Change>&)>;
  using Listener = std::function<void(const std::string& name, const ParameterValue& value)>;

  Parameters(Node& node, const Context& context);
  ~Parameters();

  /// Adds one and returns its value: what the command line or a file of parameters says, else
  /// `otherwise`. Throws Error with a sentence where what they say is refused, or the name is
  /// taken.
  ParameterValue declare_value(const ParameterInfo& info, const ParameterValue& otherwise);
  template <class T>
  T declare(const ParameterInfo& info, const T& otherwise) {
    return std::get<T>(declare_value(info, otherwise));
  }
  std::string declare(const ParameterInfo& info, const char* otherwise) {
    return declare(info, std::string(otherwise));
  }

  /// Throws Error where there is no such parameter.
  ParameterValue get_value(const std::string& name) const;
  template <class T>
  T get(const std::string& name) const {
    return std::get<T>(get_value(name));
  }

  /// All or none. Returns why none.
  Refusal set(const std::vector<Change>& changes);

  void on_set(GroupCheck check) { group_checks_.push_back(std::move(check)); }
  /// Called after a parameter has got another value, once each.
  void on_change(Listener listener) { listeners_.push_back(std::move(listener)); }

  /// What the command line and files say to this node, and nobody has declared: misspelt names.
  std::vector<std::string> undeclared() const;

  bool has(const std::string& name) const;
  std::vector<std::string> names() const;
  /// With the name alone where there is no such parameter.
  rcl_interfaces::msg::ParameterDescriptor describe(const std::string& name) const;

 private:
  struct Declared {
    ParameterInfo info;
    ParameterValue value;
  };

  Refusal prepare(const Change& change, std::vector<Change>& accepted) const;
  void tell(const std::vector<Change>& changes, bool are_new);

  Node& node_;
  std::map<std::string, ParameterValue> given_;  ///< by the command line and by files
  mutable std::mutex mutex_;                     ///< guards declared_
  std::map<std::string, Declared> declared_;
  std::vector<GroupCheck> group_checks_;
  std::vector<Listener> listeners_;
  std::shared_ptr<Publisher<rcl_interfaces::msg::ParameterEvent>> events_;
  std::unique_ptr<ParameterServices> services_;
};

}  // namespace dxslam::ros2
