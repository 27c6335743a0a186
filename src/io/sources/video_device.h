// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

namespace dxslam {

/// What a video device of Linux is asked for (V4L2): the device itself, or, in tests, one made of
/// software. One thread at a time.
class VideoDevice {
 public:
  virtual ~VideoDevice() = default;
  /// ioctl(): 0, or the error number. Never waits.
  virtual int control(unsigned long request, void* argument) = 0;
  /// mmap() of a buffer: its bytes, which live as long as this. Null if that fails.
  virtual const char* map(std::size_t length, std::uint32_t offset) = 0;
  /// What poll() waits on for a picture.
  virtual int descriptor() const = 0;
};

/// Opens the device at a path. Throws InputError.
using OpenVideoDevice = std::function<std::unique_ptr<VideoDevice>(const std::string& path)>;
std::unique_ptr<VideoDevice> open_video_device(const std::string& path);

}  // namespace dxslam
