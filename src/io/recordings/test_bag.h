// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstdint>
#include <map>
#include <opencv2/core.hpp>
#include <string>

#include "core/camera.h"

namespace dxslam {

/// A ROS 1 bag of one chunk, as a test needs it.
class TestBag {
 public:
  void add(const std::string& topic, const std::string& type, std::int64_t ns,
           const std::string& message) {
    const auto [it, is_new] =
        connections_.try_emplace(topic, static_cast<std::uint32_t>(connections_.size()));
    if (is_new) {
      chunk_ += record({{"op", "\x07"}, {"conn", number(it->second)}, {"topic", topic}},
                       fields({{"topic", topic}, {"type", type}, {"md5sum", "*"}}));
    }
    chunk_ += record({{"op", "\x02"}, {"conn", number(it->second)}, {"time", time(ns)}}, message);
  }

  void add_image(const std::string& topic, const std::string& frame, std::int64_t ns,
                 const std::string& encoding, const cv::Mat& image) {
    const cv::Mat pixels = image.isContinuous() ? image : image.clone();
    const auto step =
        static_cast<std::uint32_t>(image.cols) * static_cast<std::uint32_t>(image.elemSize());
    add(topic, "sensor_msgs/Image", ns,
        header(ns, frame) + number(static_cast<std::uint32_t>(image.rows)) +
            number(static_cast<std::uint32_t>(image.cols)) + text(encoding) + std::string(1, '\0') +
            number(step) +
            text({reinterpret_cast<const char*>(pixels.data), image.total() * image.elemSize()}));
  }

  void add_compressed(const std::string& topic, const std::string& frame, std::int64_t ns,
                      const std::string& format, const std::string& bytes) {
    add(topic, "sensor_msgs/CompressedImage", ns, header(ns, frame) + text(format) + text(bytes));
  }

  /// Rectified images have `rectified_fx` and no distortion.
  void add_camera_info(const std::string& topic, const std::string& frame, const Camera& camera,
                       double rectified_fx = 0.0, const std::string& model = "plumb_bob") {
    std::string message = header(0, frame) + number(static_cast<std::uint32_t>(camera.height)) +
                          number(static_cast<std::uint32_t>(camera.width)) + text(model) +
                          number(std::uint32_t{5});
    for (int i = 0; i < 5; ++i) message += number(camera.lens.parameters[i]);
    const double k[] = {camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1};
    for (double value : k) message += number(value);
    for (int i = 0; i < 9; ++i) message += number(i % 4 == 0 ? 1.0 : 0.0);
    const double p[] = {rectified_fx, 0, camera.cx, 0, 0, rectified_fx, camera.cy, 0, 0, 0, 1, 0};
    for (double value : p) message += number(value);
    add(topic, "sensor_msgs/CameraInfo", 0, message + std::string(25, '\0'));
  }

  void add_transform(const std::string& parent, const std::string& child, double x, double y,
                     double z) {
    std::string message = number(std::uint32_t{1}) + header(0, parent) + text(child);
    for (double value : {x, y, z, 0.0, 0.0, 0.0, 1.0}) message += number(value);
    add("/tf_static", "tf2_msgs/TFMessage", 0, message);
  }

  std::string bytes() const {
    return "#ROSBAG V2.0\n" + record({{"op", "\x05"},
                                      {"compression", "none"},
                                      {"size", number(static_cast<std::uint32_t>(chunk_.size()))}},
                                     chunk_);
  }

  template <class Number>
  static std::string number(Number value) {
    return {reinterpret_cast<const char*>(&value), sizeof(value)};
  }
  /// Behind its length.
  static std::string text(const std::string& characters) {
    return number(static_cast<std::uint32_t>(characters.size())) + characters;
  }

 private:
  using Fields = std::map<std::string, std::string>;

  static std::string time(std::int64_t ns) {
    return number(static_cast<std::uint32_t>(ns / 1'000'000'000)) +
           number(static_cast<std::uint32_t>(ns % 1'000'000'000));
  }
  static std::string header(std::int64_t ns, const std::string& frame) {
    return number(std::uint32_t{0}) + time(ns) + text(frame);
  }
  static std::string fields(const Fields& all) {
    std::string bytes;
    for (const auto& [name, value] : all) bytes += text(name + "=" + value);
    return bytes;
  }
  static std::string record(const Fields& head, const std::string& data) {
    return text(fields(head)) + text(data);
  }

  std::map<std::string, std::uint32_t> connections_;
  std::string chunk_;
};

}  // namespace dxslam
