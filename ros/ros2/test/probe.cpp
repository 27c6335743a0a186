// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
// A node that shows what the layer can do: the other end of ros2_test.py. It sends images back,
// counts them, offers services and parameters, and ticks by its clock.
#include <chrono>
#include <cstdio>
#include <dxslam_msgs/msg/features.hpp>
#include <dxslam_msgs/msg/state.hpp>
#include <dxslam_msgs/srv/save_map.hpp>
#include <exception>
#include <geometry_msgs/msg/transform_stamped.hpp>
#include <memory>
#include <sensor_msgs/msg/image.hpp>
#include <std_msgs/msg/header.hpp>
#include <std_srvs/srv/trigger.hpp>
#include <stdexcept>
#include <string>
#include <tf2_msgs/msg/tf_message.hpp>
#include <thread>

#include "ros2/context.h"
#include "ros2/executor.h"
#include "ros2/node.h"
#include "ros2/parameters.h"
#include "ros2/qos.h"
#include "ros2/signals.h"

namespace {

using namespace dxslam::ros2;  // NOLINT: a test program
using std::chrono_literals::operator""ms;

class Probe {
 public:
  Probe(const Context& context, Executor& executor) : executor_(executor), node_(context, "probe") {
    executor.add(node_);
    declare();
    back_ = node_.create_publisher<sensor_msgs::msg::Image>("image_back", reliable(40));
    transforms_ = node_.create_publisher<tf2_msgs::msg::TFMessage>("/tf", reliable(100));
    states_ = node_.create_publisher<dxslam_msgs::msg::State>("~/state", latched());
    features_ = node_.create_publisher<dxslam_msgs::msg::Features>("~/features", latched());
    ticks_ = node_.create_publisher<std_msgs::msg::Header>("~/ticks", reliable());
    images_ = node_.create_subscription<sensor_msgs::msg::Image>(
        "image", camera_data(40), [this](const auto& image) { send_back(*image); });
    faulty_ = node_.create_subscription<std_msgs::msg::Header>(
        "faulty", reliable(),
        [](const auto& message) { throw std::runtime_error(message->frame_id); });
    offer();
    timer_ = node_.create_timer(100ms, [this] { tick(); });
    publish_features();
    publish_state();
  }

 private:
  void declare() {
    Parameters& parameters = node_.parameters();
    ParameterInfo rate{.name = "rate",
                       .description = "Poses per second.",
                       .number_range = ParameterRange<double>{0.5, 60.0, 0.0}};
    parameters.declare(rate, 15.0);
    ParameterInfo levels{.name = "grid.levels",
                         .description = "Of the grid.",
                         .integer_range = ParameterRange<std::int64_t>{2, 10, 2}};
    parameters.declare<std::int64_t>(levels, 4);
    ParameterInfo mode{.name = "mode",
                       .description = "What happens to the map.",
                       .constraints = "mapping or localization",
                       .check = [](const ParameterValue& value) -> Refusal {
                         const auto& text = std::get<std::string>(value);
                         if (text == "mapping" || text == "localization") return std::nullopt;
                         return "mode is mapping or localization, not '" + text + "'.";
                       }};
    parameters.declare(mode, "mapping");
    ParameterInfo frame{.name = "frame", .description = "Of the camera.", .read_only = true};
    parameters.declare(frame, "camera");
    parameters.declare(ParameterInfo{.name = "weights"}, std::vector<double>{1.0, 2.5});
    parameters.on_set([](const std::vector<Parameters::Change>& changes) -> Refusal {
      bool slow = false;
      bool fine = false;
      for (const auto& [name, value] : changes) {
        slow = slow || (name == "rate" && std::get<double>(value) < 1.0);
        fine = fine || (name == "grid.levels" && std::get<std::int64_t>(value) > 8);
      }
      if (slow && fine) return "A rate below 1 goes with at most 8 levels.";
      return std::nullopt;
    });
    parameters.on_change([this](const std::string& name, const ParameterValue& value) {
      node_.log().info(name + " is now " + to_string(value));
    });
    for (const auto& name : parameters.undeclared()) {
      node_.log().warn("There is no parameter " + name + ".");
    }
  }

  void offer() {
    save_ = node_.create_service<dxslam_msgs::srv::SaveMap>(
        "~/save_map", [](const auto& request, auto& response) {
          response.success = !request.path.empty();
          response.message = response.success ? "Saved to " + request.path + "." : "No path.";
        });
    broken_ = node_.create_service<std_srvs::srv::Trigger>(
        "~/broken", [](const auto& /*request*/, auto& response) {
          response.message = "begun";
          throw std::runtime_error("it broke");
        });
    // As events of the library will: another thread posts a task, which answers.
    posted_ = node_.create_deferred_service<std_srvs::srv::Trigger>(
        "~/post", [this](const auto& /*request*/, auto answer) {
          worker_ = std::jthread([this, answer] {
            executor_.post([this, answer] {
              answer->response.success = true;
              answer->response.message = std::to_string(++posts_);
              answer->send();
            });
          });
        });
    dropped_ = node_.create_deferred_service<std_srvs::srv::Trigger>(
        "~/drop", [](const auto& /*request*/, auto answer) { answer->response.message = "gone"; });
    count_ = node_.create_service<std_srvs::srv::Trigger>(
        "~/count", [this](const auto& /*request*/, auto& response) {
          response.success = true;
          // What the graph says, then what is connected.
          for (const std::size_t count :
               {node_.count_publishers(images_->topic()), images_->publisher_count(),
                back_->subscriber_count(), transforms_->subscriber_count()}) {
            response.message += std::to_string(count) + " ";
          }
        });
  }

  void send_back(const sensor_msgs::msg::Image& image) {
    back_->publish(image);
    tf2_msgs::msg::TFMessage message;
    auto& transform = message.transforms.emplace_back();
    transform.header = image.header;
    transform.child_frame_id = node_.parameters().get<std::string>("frame");
    transform.transform.translation.x = ++count_of_images_;
    transform.transform.rotation.w = 1.0;
    transforms_->publish(message);
  }

  void publish_features() {
    dxslam_msgs::msg::Features features;
    features.version = dxslam_msgs::msg::Features::VERSION;
    features.extractor = "probe";
    features.keypoints = {1.0F, 2.0F, 0.5F, 1.0F};
    features.encoding = dxslam_msgs::msg::Features::FLOAT32;
    features.descriptor_size = 8;
    features.descriptors = {1, 2, 3, 4, 5, 6, 7, 8};
    features_->publish(features);
  }

  void publish_state() {
    dxslam_msgs::msg::State state;
    state.header.frame_id = node_.parameters().get<std::string>("frame");
    state.state = dxslam_msgs::msg::State::LOST;
    state.why = "a wall is all that is to be seen";
    states_->publish(state);
  }

  void tick() {
    std_msgs::msg::Header tick;
    tick.stamp = to_time(node_.clock().now());
    ticks_->publish(tick);
  }

  Executor& executor_;
  Node node_;
  int count_of_images_ = 0;
  int posts_ = 0;
  std::shared_ptr<Publisher<sensor_msgs::msg::Image>> back_;
  std::shared_ptr<Publisher<tf2_msgs::msg::TFMessage>> transforms_;
  std::shared_ptr<Publisher<dxslam_msgs::msg::State>> states_;
  std::shared_ptr<Publisher<dxslam_msgs::msg::Features>> features_;
  std::shared_ptr<Publisher<std_msgs::msg::Header>> ticks_;
  std::shared_ptr<Subscription<sensor_msgs::msg::Image>> images_;
  std::shared_ptr<Subscription<std_msgs::msg::Header>> faulty_;
  std::shared_ptr<Service<dxslam_msgs::srv::SaveMap>> save_;
  std::shared_ptr<Service<std_srvs::srv::Trigger>> broken_;
  std::shared_ptr<Service<std_srvs::srv::Trigger>> posted_;
  std::shared_ptr<Service<std_srvs::srv::Trigger>> dropped_;
  std::shared_ptr<Service<std_srvs::srv::Trigger>> count_;
  std::shared_ptr<Timer> timer_;
  std::jthread worker_;
};

}  // namespace

int main(int argc, char** argv) {
  try {
    const Context context(argc, argv);
    for (const std::string& argument : context.arguments()) {
      std::fprintf(stderr, "argument %s\n", argument.c_str());
    }
    Executor executor(context);
    const StopOnSignal stop_on_signal([&] { executor.stop(); });
    Probe probe(context, executor);
    executor.spin();
    std::fprintf(stderr, "ended\n");
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "probe: %s\n", error.what());
    return 1;
  }
}
