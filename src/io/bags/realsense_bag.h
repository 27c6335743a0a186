// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <optional>
#include <string>

#include "core/se3.h"
#include "io/bags/bag_file.h"

namespace dxslam {

// What is peculiar to the recordings of librealsense: ROS 1 bags until version 2.56, SQLite bags
// since 2.59. A stream such as "/device_0/sensor_0/Depth_0" is a folder of topics, and what is
// known of it is in texts or types of its own.

/// The stream whose images the topic holds ("…/image/data", also compressed); empty for a topic of
/// other recorders.
std::string realsense_stream(const std::string& topic);

/// Raw depth units per metre, of the sensor that the stream is of; nothing if the bag does not say.
std::optional<double> realsense_depth_factor(BagFile& bag, const std::string& stream);

/// Whether the colour camera's distortion is "Inverse Brown Conrady": the polynomial gives the
/// ideal pixel by the raw one. Its camera_info may call it plumb_bob all the same.
bool has_inverse_distortion(BagFile& bag, const std::string& stream);

/// color_from_depth, of two streams of a ROS 1 bag.
std::optional<SE3> realsense_transform(BagFile& bag, const std::string& color_stream,
                                       const std::string& depth_stream);

}  // namespace dxslam
