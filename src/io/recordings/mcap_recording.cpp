// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
//
// A recording as MCAP: what `ros2 bag record` would have written of a camera with aligned depth.
#include <cmath>
#include <cstdint>
#include <optional>

#include "core/error.h"
#include "io/bags/mcap_writer.h"
#include "io/bags/ros_message_writer.h"
#include "io/calibration/calibration.h"
#include "io/recordings/recording_formats.h"

namespace dxslam {
namespace {

constexpr const char* kFrame = "camera_color_optical_frame";  // depth is registered to colour
constexpr double kMillimetres = 1000.0;                       // of 16UC1, by ROS' convention

class McapRecording : public RecordingWriter {
 public:
  McapRecording(std::string path, const Camera& camera) : path_(std::move(path)), camera_(camera) {
    camera_.depth_factor = kMillimetres;
  }

  void add(const RgbdImage& image) override {
    require(image.stamp >= 0.0, "a recording has no stamps before 1970");
    const auto ns = static_cast<std::int64_t>(std::llround(image.stamp * 1e6)) * 1000;
    if (!writer_) begin(ns);
    add_image(color_, color_info_, image.color, ns);
    if (!image.depth.empty()) {
      bool exact = false;
      const cv::Mat raw = raw_depth(image.depth, kMillimetres, exact);
      add_image(depth_, depth_info_, exact ? raw : image.depth, ns);
    }
    writer_->flush();
    ++size_;
  }

  void finish() override {
    if (writer_) writer_->finish();
  }
  std::size_t size() const override { return size_; }
  const std::vector<std::string>& notes() const override { return notes_; }

 private:
  void begin(std::int64_t ns) {
    writer_.emplace(path_, "zstd");
    const auto topic = [this](const char* name, const RosType& type) {
      return writer_->add_topic(name, type.name, type.definition);
    };
    color_ = topic("/camera/color/image_raw", ros_image_type());
    color_info_ = topic("/camera/color/camera_info", ros_camera_info_type());
    depth_ = topic("/camera/aligned_depth_to_color/image_raw", ros_image_type());
    depth_info_ = topic("/camera/aligned_depth_to_color/camera_info", ros_camera_info_type());
    const std::string text = dump_camera(camera_, "calibration of this recording");
    writer_->add(topic(kCalibrationTopic, ros_string_type()), static_cast<std::uint64_t>(ns),
                 write_ros_string(text));
  }

  void add_image(std::uint16_t topic, std::uint16_t info, const cv::Mat& image, std::int64_t ns) {
    const auto time = static_cast<std::uint64_t>(ns);
    writer_->add(info, time, write_ros_camera_info(camera_, ns, kFrame));
    writer_->add(topic, time, write_ros_image(image, ns, kFrame));
  }

  std::string path_;
  Camera camera_;
  std::optional<McapWriter> writer_;
  std::uint16_t color_ = 0, color_info_ = 0, depth_ = 0, depth_info_ = 0;
  std::size_t size_ = 0;
  std::vector<std::string> notes_;
};

}  // namespace

std::unique_ptr<RecordingWriter> create_mcap_recording(const std::string& path,
                                                       const ImageOrigin& origin) {
  return std::make_unique<McapRecording>(path, origin.camera());
}

}  // namespace dxslam
