// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "ros2/node.h"

#include <rcl/graph.h>
#include <rcl/logging.h>
#include <rcl/logging_rosout.h>
#include <rcl/node_options.h>

#include "ros2/error.h"
#include "ros2/parameters.h"

namespace dxslam::ros2 {
namespace {

NodeHandle make_node(const std::shared_ptr<rcl_context_t>& context, const std::string& name,
                     const std::string& name_space) {
  rcl_node_options_t options = rcl_node_get_default_options();
  auto node = std::make_unique<rcl_node_t>(rcl_get_zero_initialized_node());
  check(rcl_node_init(node.get(), name.c_str(), name_space.c_str(), context.get(), &options),
        "the node '" + name + "' cannot be made in the namespace '" + name_space + "'");
  const bool logs = rcl_logging_rosout_enabled();
  if (logs) {
    check(rcl_logging_rosout_init_publisher_for_node(node.get()),
          "the log of the node '" + name + "' cannot be published");
  }
  return {node.release(), [context, logs](rcl_node_t* made) {
            if (logs && rcl_logging_rosout_fini_publisher_for_node(made) != RCL_RET_OK) {
              take_rcl_error();
            }
            if (rcl_node_fini(made) != RCL_RET_OK) take_rcl_error();
            delete made;
          }};
}

}  // namespace

Node::Node(const Context& context, const std::string& name, const std::string& name_space)
    : context_(context.handle()),
      handle_(make_node(context_, name, name_space)),
      full_name_(rcl_node_get_fully_qualified_name(handle_.get())),
      log_(handle_),
      parameters_(std::make_unique<Parameters>(*this, context)) {
  ParameterInfo info;
  info.name = "use_sim_time";
  info.description = "Take the time from /clock, as simulators and players of bags publish it.";
  follow_simulation(parameters_->declare(info, false));
  parameters_->on_change([this](const std::string& changed, const ParameterValue& value) {
    if (changed == "use_sim_time") follow_simulation(std::get<bool>(value));
  });
}

Node::~Node() = default;

void Node::follow_simulation(bool yes) {
  if (yes == clock_.is_simulated()) return;
  clock_.follow_simulation(yes);
  simulated_time_.reset();
  if (!yes) return;
  Qos qos = sensor_data();
  qos.depth = 1;
  simulated_time_ = create_subscription<rosgraph_msgs::msg::Clock>(
      "/clock", qos, [this](const std::shared_ptr<const rosgraph_msgs::msg::Clock>& message) {
        if (clock_.is_simulated()) clock_.set_simulated(to_nanoseconds(message->clock));
      });
}

std::shared_ptr<Timer> Node::create_timer(std::chrono::nanoseconds period,
                                          Timer::Callback callback) {
  return keep(std::make_shared<Timer>(context_, clock_.handle(), period, std::move(callback)));
}

std::shared_ptr<Timer> Node::create_wall_timer(std::chrono::nanoseconds period,
                                               Timer::Callback callback) {
  return keep(std::make_shared<Timer>(context_, steady_clock(), period, std::move(callback)));
}

std::size_t Node::count_publishers(const std::string& topic) const {
  std::size_t count = 0;
  check(rcl_count_publishers(handle_.get(), topic.c_str(), &count),
        "the publishers of " + topic + " cannot be counted");
  return count;
}

std::vector<std::shared_ptr<Entity>> Node::entities() {
  std::vector<std::shared_ptr<Entity>> alive;
  std::erase_if(entities_, [&](const std::weak_ptr<Entity>& entity) {
    auto held = entity.lock();
    if (held) alive.push_back(std::move(held));
    return !held && entity.expired();
  });
  return alive;
}

}  // namespace dxslam::ros2
