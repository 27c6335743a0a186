// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <string>

#include "core/camera.h"

namespace dxslam {

// Messages of ROS 2 (CDR, little-endian), which ros_message.h reads.

/// A type of messages and its definition in the form that ROS 2 writes into MCAP files.
struct RosType {
  std::string name;
  std::string definition;
};
RosType ros_image_type();
RosType ros_camera_info_type();
RosType ros_string_type();

/// sensor_msgs/msg/Image of CV_8UC1 (mono8), CV_8UC3 (bgr8), CV_16UC1 (16UC1) or CV_32FC1 (32FC1).
/// Throws ContractError for other types.
std::string write_ros_image(const cv::Mat& image, std::int64_t stamp_ns, const std::string& frame);
/// sensor_msgs/msg/CameraInfo of a camera whose images are raw.
std::string write_ros_camera_info(const Camera& camera, std::int64_t stamp_ns,
                                  const std::string& frame);
/// std_msgs/msg/String
std::string write_ros_string(const std::string& text);

}  // namespace dxslam
