// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/sources/video_stream.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <linux/videodev2.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <opencv2/imgproc.hpp>
#include <string_view>

#include "core/error.h"
#include "io/primitives/image_file.h"

namespace dxslam {

/// A way in which devices lay out pictures.
struct PixelFormat {
  std::uint32_t code;
  const char* name;
  bool is_depth;
  int raw_type;  // of the pixels in the buffer; -1: a file
  int to_bgr;    // of cv::cvtColor; -1: none
};

namespace {

constexpr std::uint32_t kBuffers = 4;
constexpr unsigned kMostFormats = 64;  // a device lists

// The likeliest first.
constexpr PixelFormat kFormats[] = {
    {V4L2_PIX_FMT_Z16, "Z16", true, CV_16UC1, -1},
    {V4L2_PIX_FMT_YUYV, "YUYV", false, CV_8UC2, cv::COLOR_YUV2BGR_YUYV},
    {V4L2_PIX_FMT_BGR24, "BGR3", false, CV_8UC3, -1},
    {V4L2_PIX_FMT_RGB24, "RGB3", false, CV_8UC3, cv::COLOR_RGB2BGR},
    {V4L2_PIX_FMT_MJPEG, "MJPG", false, -1, -1},
    {V4L2_PIX_FMT_GREY, "GREY", false, CV_8UC1, -1},
};

std::string name_of(std::uint32_t code) {
  std::string name(4, ' ');
  std::memcpy(name.data(), &code, name.size());
  return name;
}

double seconds_now(clockid_t clock) {
  timespec now{};
  ::clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// From the device's clock, where it is one of the system, to that since 1970. The difference is
// taken once, so that a clock that is set meanwhile moves no stamp.
double stamp_of(const v4l2_buffer& buffer) {
  static const double since_1970 = seconds_now(CLOCK_REALTIME) - seconds_now(CLOCK_MONOTONIC);
  const bool monotonic =
      (buffer.flags & V4L2_BUF_FLAG_TIMESTAMP_MASK) == V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
  if (!monotonic) return seconds_now(CLOCK_MONOTONIC) + since_1970;
  return static_cast<double>(buffer.timestamp.tv_sec) +
         1e-6 * static_cast<double>(buffer.timestamp.tv_usec) + since_1970;
}

v4l2_buffer empty_buffer() {
  v4l2_buffer buffer{};
  buffer.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  buffer.memory = V4L2_MEMORY_MMAP;
  return buffer;
}

}  // namespace

VideoStream::VideoStream(const std::string& path, std::unique_ptr<VideoDevice> device,
                         bool is_depth, cv::Size size, double fps)
    : path_(path), device_(std::move(device)), is_depth_(is_depth), size_(size) {
  require_camera();
  choose_format(size);
  ask_for_rate(fps);
  lend_buffers();
  int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  check(device_->control(VIDIOC_STREAMON, &type), "does not start");
}

VideoStream::~VideoStream() {
  int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  device_->control(VIDIOC_STREAMOFF, &type);
}

void VideoStream::check(int error, const char* what) const {
  if (error == 0) return;
  if (error == ENODEV) {
    throw InputError(path_ + ": the camera was unplugged, expected it to stay");
  }
  const std::string busy = error == EBUSY ? ", another program uses it" : "";
  throw InputError(
      fmt::format("{}: the video device {}: {}{}", path_, what, std::strerror(error), busy));
}

void VideoStream::require_camera() {
  v4l2_capability capability{};
  check(device_->control(VIDIOC_QUERYCAP, &capability), "does not say what it can");
  const std::uint32_t can = (capability.capabilities & V4L2_CAP_DEVICE_CAPS) != 0
                                ? capability.device_caps
                                : capability.capabilities;
  if ((can & V4L2_CAP_VIDEO_CAPTURE) != 0 && (can & V4L2_CAP_STREAMING) != 0) return;
  throw InputError(path_ + ": this video device gives no pictures, expected another of the camera");
}

void VideoStream::choose_format(cv::Size size) {
  std::vector<std::uint32_t> offered;
  for (std::uint32_t i = 0; i < kMostFormats; ++i) {
    v4l2_fmtdesc description{};
    description.index = i;
    description.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    if (device_->control(VIDIOC_ENUM_FMT, &description) != 0) break;
    offered.push_back(description.pixelformat);
  }
  std::vector<const char*> known;
  for (const PixelFormat& format : kFormats) {
    if (format.is_depth != is_depth_) continue;
    known.push_back(format.name);
    if (std::find(offered.begin(), offered.end(), format.code) == offered.end()) continue;
    if (try_format(format, size)) return;
  }
  std::vector<std::string> names;
  for (const std::uint32_t code : offered) names.push_back(name_of(code));
  throw InputError(fmt::format(
      "{}: gives no {} images of {}x{} pixels, the size of the calibration, as {}; it has {}",
      path_, is_depth_ ? "depth" : "colour", size.width, size.height, fmt::join(known, ", "),
      names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "))));
}

bool VideoStream::try_format(const PixelFormat& format, cv::Size size) {
  v4l2_format wanted{};
  wanted.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  wanted.fmt.pix.width = static_cast<std::uint32_t>(size.width);
  wanted.fmt.pix.height = static_cast<std::uint32_t>(size.height);
  wanted.fmt.pix.pixelformat = format.code;
  wanted.fmt.pix.field = V4L2_FIELD_NONE;
  const int error = device_->control(VIDIOC_S_FMT, &wanted);
  if (error == EBUSY || error == ENODEV) check(error, "takes no format");
  const v4l2_pix_format& got = wanted.fmt.pix;  // a device gives what is nearest
  if (error != 0 || got.pixelformat != format.code ||
      got.width != static_cast<std::uint32_t>(size.width) ||
      got.height != static_cast<std::uint32_t>(size.height)) {
    return false;
  }
  format_ = &format;
  const std::size_t least =
      format.raw_type < 0 ? 0
                          : CV_ELEM_SIZE(format.raw_type) * static_cast<std::size_t>(size.width);
  row_bytes_ = std::max<std::size_t>(got.bytesperline, least);
  return true;
}

// A device that cannot choose keeps its own.
void VideoStream::ask_for_rate(double fps) {
  if (fps == 0.0) return;
  constexpr double kParts = 1000.0;
  v4l2_streamparm parameters{};
  parameters.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  parameters.parm.capture.timeperframe = {static_cast<std::uint32_t>(kParts),
                                          static_cast<std::uint32_t>(kParts * fps)};
  device_->control(VIDIOC_S_PARM, &parameters);
}

void VideoStream::lend_buffers() {
  v4l2_requestbuffers request{};
  request.count = kBuffers;
  request.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  request.memory = V4L2_MEMORY_MMAP;
  check(device_->control(VIDIOC_REQBUFS, &request), "has no buffers");
  for (std::uint32_t i = 0; i < request.count; ++i) {
    v4l2_buffer buffer = empty_buffer();
    buffer.index = i;
    check(device_->control(VIDIOC_QUERYBUF, &buffer), "does not show its buffers");
    const char* start = device_->map(buffer.length, buffer.m.offset);
    if (start == nullptr) throw InputError(path_ + ": the video device does not share its buffers");
    buffers_.push_back({start, buffer.length});
    check(device_->control(VIDIOC_QBUF, &buffer), "takes no buffer");
  }
}

std::optional<LivePicture> VideoStream::take() {
  v4l2_buffer buffer = empty_buffer();
  const int error = device_->control(VIDIOC_DQBUF, &buffer);
  if (error == EAGAIN || error == EIO) return std::nullopt;  // of the latter the next may be whole
  check(error, "gives no pictures any more");
  if (buffer.index >= buffers_.size()) {
    throw InputError(path_ + ": the video device gives a buffer that it was not lent");
  }
  LivePicture picture;
  if ((buffer.flags & V4L2_BUF_FLAG_ERROR) != 0) {
    picture.problem = "the camera says that it is damaged";
  } else {
    picture = picture_of(buffer.index, buffer.bytesused);
  }
  picture.is_depth = is_depth_;
  picture.stamp = stamp_of(buffer);
  check(device_->control(VIDIOC_QBUF, &buffer), "takes no buffer");
  return picture;
}

LivePicture VideoStream::picture_of(std::uint32_t index, std::size_t bytes) const {
  const Buffer& buffer = buffers_[index];
  const std::size_t used = std::min(bytes, buffer.length);
  LivePicture picture;
  if (format_->raw_type < 0) {
    try {
      picture.image = decode_color_image({buffer.start, used}, path_);
    } catch (const InputError& e) {
      picture.problem = e.what();
    }
    return picture;
  }
  const auto rows = static_cast<std::size_t>(size_.height);
  const std::size_t last_row =
      CV_ELEM_SIZE(format_->raw_type) * static_cast<std::size_t>(size_.width);
  if (used < row_bytes_ * (rows - 1) + last_row) {
    picture.problem = fmt::format("it is cut off, {} of {} bytes came", used, row_bytes_ * rows);
    return picture;
  }
  const cv::Mat raw(size_, format_->raw_type, const_cast<char*>(buffer.start), row_bytes_);
  if (format_->to_bgr < 0) {
    picture.image = raw.clone();
  } else {
    cv::cvtColor(raw, picture.image, format_->to_bgr);
  }
  return picture;
}

}  // namespace dxslam
