// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/bags/realsense_bag.h"

#include <cmath>

#include "core/error.h"
#include "io/bags/ros_message.h"
#include "io/primitives/text_file.h"

namespace dxslam {
namespace {

constexpr double kFinestUnit = 1e-6;  // metres
constexpr double kFigures = 1e3;

bool begins_with(const std::string& text, const std::string& start) {
  return text.compare(0, start.size(), start) == 0;
}

// "/device_0/sensor_0" of "/device_0/sensor_0/Depth_0".
std::string sensor_of(const std::string& stream) { return stream.substr(0, stream.rfind('/')); }

// The bytes of the first message of the first topic whose name begins so; nothing if there is none.
struct First {
  const BagTopic* topic = nullptr;
  std::string bytes;
};
std::optional<First> first_message(BagFile& bag, const std::string& name, bool whole_name) {
  for (const BagEntry& entry : bag.entries()) {
    const BagTopic& topic = bag.topics()[entry.topic];
    if (whole_name ? topic.name != name : !begins_with(topic.name, name)) continue;
    try {
      return First{&topic, bag.read(entry)};
    } catch (const InputError&) {
      continue;
    }
  }
  return std::nullopt;
}

}  // namespace

std::string realsense_stream(const std::string& topic) {
  const std::size_t at = topic.find("/image/data");
  const bool is_one = begins_with(topic, "/device_") && at != std::string::npos;
  return is_one ? topic.substr(0, at) : std::string();
}

std::optional<double> realsense_depth_factor(BagFile& bag, const std::string& stream) {
  if (stream.empty()) return std::nullopt;
  const auto found = first_message(bag, sensor_of(stream) + "/option/Depth_Units/value", true);
  if (!found) return std::nullopt;
  try {
    const std::string& where = found->topic->name;
    const std::optional<double> metres =
        found->topic->type == "std_msgs/String"
            ? parse_number(read_ros_string(found->bytes, found->topic->encoding, where))
            : read_ros_float(found->bytes, found->topic->encoding, where);
    if (metres && *metres > kFinestUnit && *metres < 1.0) {
      return std::round(kFigures / *metres) / kFigures;  // as a float has it, 0.001 is not quite
    }
  } catch (const InputError&) {
    return std::nullopt;
  }
  return std::nullopt;
}

bool has_inverse_distortion(BagFile& bag, const std::string& stream) {
  for (const char* topic : {"/camera_info", "/info/camera_info"}) {
    const auto found = first_message(bag, stream + topic, true);
    if (found && found->bytes.find("Inverse Brown Conrady") != std::string::npos) return true;
  }
  return false;
}

std::optional<SE3> realsense_transform(BagFile& bag, const std::string& color_stream,
                                       const std::string& depth_stream) {
  if (color_stream.empty() || depth_stream.empty()) return std::nullopt;
  // Both are seen from one stream of the device, the same for all.
  const auto from_reference = [&](const std::string& stream) -> std::optional<SE3> {
    const auto found = first_message(bag, stream + "/tf/", false);
    if (!found || found->topic->type != "geometry_msgs/Transform") return std::nullopt;
    try {
      return read_ros_transform(found->bytes, found->topic->encoding, found->topic->name);
    } catch (const InputError&) {
      return std::nullopt;
    }
  };
  const auto color = from_reference(color_stream);
  const auto depth = from_reference(depth_stream);
  if (!color || !depth) return std::nullopt;
  return *color * depth->inverse();
}

}  // namespace dxslam
