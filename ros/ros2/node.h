// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "ros2/clock.h"
#include "ros2/context.h"
#include "ros2/entity.h"
#include "ros2/log.h"
#include "ros2/publisher.h"
#include "ros2/service.h"
#include "ros2/subscription.h"
#include "ros2/timer.h"

#include <rosgraph_msgs/msg/clock.hpp>

namespace dxslam::ros2 {

class Parameters;

/// A node as others see it: in the graph, with its parameters, its log and its clock. What it
/// creates belongs to the caller, and works while the caller holds it. All in the executor's
/// thread, or before it spins, unless said otherwise. Topics and services are named as usual:
/// relative, from the root ("/tf"), or private ("~/state"); the command line may remap them, the
/// name and the namespace.
class Node {
 public:
  /// Throws Error where `name` or `name_space` cannot be one.
  Node(const Context& context, const std::string& name, const std::string& name_space = "");
  ~Node();
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;

  /// With its namespace, after remapping: "/robot/slam".
  const std::string& full_name() const { return full_name_; }

  template <class Message>
  std::shared_ptr<Publisher<Message>> create_publisher(const std::string& topic, const Qos& qos) {
    return keep(std::make_shared<Publisher<Message>>(handle_, topic, qos));
  }
  template <class Message>
  std::shared_ptr<Subscription<Message>> create_subscription(
      const std::string& topic, const Qos& qos, typename Subscription<Message>::Callback callback) {
    return keep(std::make_shared<Subscription<Message>>(handle_, topic, qos, std::move(callback)));
  }
  template <class Type>
  std::shared_ptr<Service<Type>> create_service(const std::string& name,
                                                typename Service<Type>::Callback callback,
                                                const Qos& qos = rmw_qos_profile_services_default) {
    return create_deferred_service<Type>(
        name,
        [callback = std::move(callback)](const auto& request, const auto& answer) {
          callback(request, answer->response);
        },
        qos);
  }
  template <class Type>
  std::shared_ptr<Service<Type>> create_deferred_service(
      const std::string& name, typename Service<Type>::DeferredCallback callback,
      const Qos& qos = rmw_qos_profile_services_default) {
    return keep(std::make_shared<Service<Type>>(handle_, name, qos, std::move(callback)));
  }
  /// By the node's clock, so that it stands still where a simulation does.
  std::shared_ptr<Timer> create_timer(std::chrono::nanoseconds period, Timer::Callback callback);
  /// By the computer's steady clock.
  std::shared_ptr<Timer> create_wall_timer(std::chrono::nanoseconds period,
                                           Timer::Callback callback);

  Parameters& parameters() { return *parameters_; }
  const Clock& clock() const { return clock_; }
  const Logger& log() const { return log_; }
  /// How many publishers a topic of that full name has, ours included. Any thread.
  std::size_t count_publishers(const std::string& topic) const;

  /// For the executor.
  std::vector<std::shared_ptr<Entity>> entities();
  const NodeHandle& handle() const { return handle_; }

 private:
  template <class T>
  std::shared_ptr<T> keep(std::shared_ptr<T> entity) {
    entities_.push_back(entity);
    return entity;
  }
  void follow_simulation(bool yes);

  std::shared_ptr<rcl_context_t> context_;
  NodeHandle handle_;
  std::string full_name_;
  Logger log_;
  Clock clock_;
  std::vector<std::weak_ptr<Entity>> entities_;
  std::unique_ptr<Parameters> parameters_;
  std::shared_ptr<Subscription<rosgraph_msgs::msg::Clock>> simulated_time_;
};

}  // namespace dxslam::ros2
