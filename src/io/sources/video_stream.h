// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstdint>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "io/sources/live_camera.h"
#include "io/sources/video_device.h"

namespace dxslam {

struct PixelFormat;

/// Pictures of one video device: agrees with it on a format and a size, lends it buffers, and
/// takes pictures out of them. A new format is a row in the table of video_stream.cpp. One thread.
class VideoStream {
 public:
  /// Starts the device. `fps`: asked for, 0: the device's own. Throws InputError if it is no
  /// camera, or does not give such pictures.
  VideoStream(const std::string& path, std::unique_ptr<VideoDevice> device, bool is_depth,
              cv::Size size, double fps);
  ~VideoStream();
  VideoStream(const VideoStream&) = delete;
  VideoStream& operator=(const VideoStream&) = delete;

  /// The next picture if there is one already. Throws InputError if the device is gone.
  std::optional<LivePicture> take();
  int descriptor() const { return device_->descriptor(); }

 private:
  struct Buffer {
    const char* start = nullptr;
    std::size_t length = 0;
  };

  void require_camera();
  void choose_format(cv::Size size);
  bool try_format(const PixelFormat& format, cv::Size size);
  void ask_for_rate(double fps);
  void lend_buffers();
  void check(int error, const char* what) const;
  LivePicture picture_of(std::uint32_t index, std::size_t bytes) const;

  std::string path_;
  std::unique_ptr<VideoDevice> device_;
  bool is_depth_;
  const PixelFormat* format_ = nullptr;
  cv::Size size_;
  std::size_t row_bytes_ = 0;
  std::vector<Buffer> buffers_;
};

}  // namespace dxslam
