// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/se3.h"
#include "io/bags/bag_file.h"

namespace dxslam {

// The messages that a recording of an RGB-D camera is made of, read from the bytes of ROS 1 or
// ROS 2. Every function throws InputError, beginning with `where`, for bytes that end too early or
// hold impossible sizes. Views point into the bytes given.

struct RosHeader {
  std::int64_t stamp_ns = 0;  ///< when the picture was taken
  std::string frame;          ///< name of the coordinate frame
};

/// sensor_msgs/Image
struct RosImage {
  RosHeader header;
  std::uint32_t height = 0, width = 0;
  std::string encoding;
  bool big_endian = false;
  std::uint32_t step = 0;  ///< bytes per row
  std::string_view data;
};

/// sensor_msgs/CompressedImage
struct RosCompressedImage {
  RosHeader header;
  std::string format;
  std::string_view data;
};

/// sensor_msgs/CameraInfo, without what nothing here uses
struct RosCameraInfo {
  RosHeader header;
  std::uint32_t height = 0, width = 0;
  std::string distortion_model;
  std::vector<double> d;
  std::array<double, 9> k{};   ///< of the raw image
  std::array<double, 12> p{};  ///< of the rectified image
};

/// One transform of tf2_msgs/TFMessage: x_in_parent = parent_from_child * x_in_child.
struct RosTransform {
  std::string parent, child;
  SE3 parent_from_child;
};

/// Of any message that begins with one.
RosHeader read_ros_header(std::string_view bytes, MessageEncoding encoding,
                          const std::string& where);
RosImage read_ros_image(std::string_view bytes, MessageEncoding encoding, const std::string& where);
RosCompressedImage read_ros_compressed_image(std::string_view bytes, MessageEncoding encoding,
                                             const std::string& where);
RosCameraInfo read_ros_camera_info(std::string_view bytes, MessageEncoding encoding,
                                   const std::string& where);
/// std_msgs/String and std_msgs/Float32
std::string read_ros_string(std::string_view bytes, MessageEncoding encoding,
                            const std::string& where);
float read_ros_float(std::string_view bytes, MessageEncoding encoding, const std::string& where);
/// geometry_msgs/Transform
SE3 read_ros_transform(std::string_view bytes, MessageEncoding encoding, const std::string& where);
/// tf2_msgs/TFMessage, without transforms that are none
std::vector<RosTransform> read_ros_transforms(std::string_view bytes, MessageEncoding encoding,
                                              const std::string& where);

}  // namespace dxslam
