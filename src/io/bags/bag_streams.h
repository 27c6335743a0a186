// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "io/bags/bag_file.h"
#include "io/bags/ros_message.h"

namespace dxslam {

/// The pictures of one topic.
struct PictureStream {
  std::uint32_t topic = 0;  ///< index into BagFile::topics()
  std::string name;
  bool compressed = false;  ///< sensor_msgs/CompressedImage
  bool depth = false;       ///< else colour or grey
  std::string encoding;     ///< of its first message
  std::string frame;        ///< of its first message, without a slash in front
  cv::Size size;            ///< of its first message; empty where it is compressed
  std::size_t messages = 0;
  MessageEncoding layout = MessageEncoding::kRos1;
};

/// Every topic of pictures, with what its first whole message says. Topics without one are left
/// out.
std::vector<PictureStream> find_picture_streams(BagFile& bag);

/// The messages of a topic in the order in which they lie in the file: read so, each chunk is
/// unpacked once.
std::vector<BagEntry> in_file_order(const BagFile& bag, std::uint32_t topic);

/// The stream called `wanted`, or if that is empty the one that an RGB-D recording is likely made
/// of: for colour a name with color or rgb and no infra. Throws InputError naming what there is if
/// there is none, or for a name that is not there. `where` begins messages.
PictureStream choose_color(const std::vector<PictureStream>& streams, const std::string& wanted,
                           const std::string& where);
/// The same for depth: of the same camera as colour by its name, then one that is registered to
/// colour. Nothing where the bag has none and none is wanted.
std::optional<PictureStream> choose_depth(const std::vector<PictureStream>& streams,
                                          const PictureStream& color, const std::string& wanted,
                                          const std::string& where);

/// A calibration and the topic that says it.
struct FoundCameraInfo {
  std::string topic;
  RosCameraInfo info;
};
/// The first calibration on the topic beside the stream's, or else on one of the same coordinate
/// frame.
std::optional<FoundCameraInfo> camera_info_of(BagFile& bag, const PictureStream& stream);

/// Whether the name says that the images are free of distortion ("image_rect_color").
bool says_rectified(const PictureStream& stream);
/// Whether the name or the frame says that depth has been registered to colour.
bool says_registered(const PictureStream& depth, const PictureStream& color);

/// to_from_from by the transforms of the bag (/tf_static, then /tf); nothing if they do not tie the
/// two frames together. The first transform between two frames counts: a camera is rigid.
std::optional<SE3> find_transform(BagFile& bag, const std::string& to_frame,
                                  const std::string& from_frame);

}  // namespace dxslam
