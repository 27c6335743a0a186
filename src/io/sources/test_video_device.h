// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <linux/videodev2.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <cerrno>
#include <deque>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "io/sources/video_device.h"

namespace dxslam {

/// What a software camera is and does; shared by the device and the test.
struct SoftwareCamera {
  std::vector<std::uint32_t> formats;
  int width = 0, height = 0;    // the only size that it has
  std::uint32_t row_bytes = 0;  // 0: of a file
  bool gives_pictures = true;   // else it is some other video device
  int start_error = 0;          // of STREAMON
  std::size_t buffer_bytes = 1 << 20;

  struct Picture {
    std::string bytes;
    double stamp = 0.0;  // of the monotonic clock
    std::uint32_t flags = 0;
  };
  /// Any thread.
  void give(Picture picture) {
    const std::lock_guard lock(mutex);
    pictures.push_back(std::move(picture));
    wake();
  }
  void unplug() {
    const std::lock_guard lock(mutex);
    unplugged = true;
    wake();
  }
  void wake() const {
    const std::uint64_t one = 1;
    static_cast<void>(!::write(event, &one, sizeof(one)));
  }

  std::mutex mutex;
  int event = ::eventfd(0, EFD_NONBLOCK | EFD_SEMAPHORE);
  std::deque<Picture> pictures;
  bool unplugged = false;
  bool streams = false;
  std::uint32_t asked_format = 0;
  double asked_fps = 0.0;
  int lent = 0;  // buffers that the device has
};

class SoftwareDevice : public VideoDevice {
 public:
  explicit SoftwareDevice(SoftwareCamera& camera) : camera_(camera) {}

  int descriptor() const override { return camera_.event; }
  const char* map(std::size_t length, std::uint32_t offset) override {
    return length == camera_.buffer_bytes && offset < memory_.size() ? memory_[offset].data()
                                                                     : nullptr;
  }
  int control(unsigned long request, void* argument) override {
    const std::lock_guard lock(camera_.mutex);
    if (camera_.unplugged) return ENODEV;
    switch (request) {
      case VIDIOC_QUERYCAP:
        return query(*static_cast<v4l2_capability*>(argument));
      case VIDIOC_ENUM_FMT:
        return list(*static_cast<v4l2_fmtdesc*>(argument));
      case VIDIOC_S_FMT:
        return set_format(static_cast<v4l2_format*>(argument)->fmt.pix);
      case VIDIOC_S_PARM: {
        const v4l2_fract step = static_cast<v4l2_streamparm*>(argument)->parm.capture.timeperframe;
        camera_.asked_fps = static_cast<double>(step.denominator) / step.numerator;
        return 0;
      }
      case VIDIOC_REQBUFS:
        memory_.assign(static_cast<v4l2_requestbuffers*>(argument)->count,
                       std::string(camera_.buffer_bytes, '\0'));
        return 0;
      case VIDIOC_QUERYBUF: {
        auto& buffer = *static_cast<v4l2_buffer*>(argument);
        buffer.length = static_cast<std::uint32_t>(camera_.buffer_bytes);
        buffer.m.offset = buffer.index;
        return 0;
      }
      case VIDIOC_QBUF:
        lent_.push_back(static_cast<v4l2_buffer*>(argument)->index);
        camera_.lent = static_cast<int>(lent_.size());
        return 0;
      case VIDIOC_DQBUF:
        return fill(*static_cast<v4l2_buffer*>(argument));
      case VIDIOC_STREAMON:
        camera_.streams = camera_.start_error == 0;
        return camera_.start_error;
      case VIDIOC_STREAMOFF:
        camera_.streams = false;
        return 0;
      default:
        return EINVAL;
    }
  }

 private:
  int query(v4l2_capability& capability) const {
    capability.capabilities = V4L2_CAP_DEVICE_CAPS;
    capability.device_caps = camera_.gives_pictures ? V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING
                                                    : V4L2_CAP_META_CAPTURE;
    return 0;
  }
  int list(v4l2_fmtdesc& description) const {
    if (description.index >= camera_.formats.size()) return EINVAL;
    description.pixelformat = camera_.formats[description.index];
    return 0;
  }
  int set_format(v4l2_pix_format& format) const {
    camera_.asked_format = format.pixelformat;
    format.width = static_cast<std::uint32_t>(camera_.width);
    format.height = static_cast<std::uint32_t>(camera_.height);
    format.bytesperline = camera_.row_bytes;
    return 0;
  }
  int fill(v4l2_buffer& buffer) {
    std::uint64_t taken = 0;
    static_cast<void>(!::read(camera_.event, &taken, sizeof(taken)));
    if (camera_.pictures.empty() || lent_.empty()) return EAGAIN;
    const SoftwareCamera::Picture picture = std::move(camera_.pictures.front());
    camera_.pictures.pop_front();
    buffer.index = lent_.front();
    lent_.pop_front();
    camera_.lent = static_cast<int>(lent_.size());
    picture.bytes.copy(memory_[buffer.index].data(), picture.bytes.size());
    buffer.bytesused = static_cast<std::uint32_t>(picture.bytes.size());
    buffer.flags = picture.flags | V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
    buffer.timestamp.tv_sec = static_cast<time_t>(picture.stamp);
    buffer.timestamp.tv_usec = static_cast<suseconds_t>(
        (picture.stamp - static_cast<double>(buffer.timestamp.tv_sec)) * 1e6);
    return 0;
  }

  SoftwareCamera& camera_;
  std::vector<std::string> memory_;
  std::deque<std::uint32_t> lent_;
};

}  // namespace dxslam
