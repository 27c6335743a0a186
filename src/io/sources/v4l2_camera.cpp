// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/sources/v4l2_camera.h"

#include <fmt/format.h>
#include <poll.h>

#include <utility>
#include <vector>

#include "core/error.h"
#include "io/sources/video_stream.h"

namespace dxslam {
namespace {

class V4l2Camera : public LiveCamera {
 public:
  V4l2Camera(RgbdCalibration calibration, std::string calibration_source)
      : calibration_(std::move(calibration)), calibration_source_(std::move(calibration_source)) {}

  void add(const std::string& path, std::unique_ptr<VideoDevice> device, double fps) {
    const bool is_depth = !streams_.empty();
    const DepthCamera& depth = calibration_.depth_camera;
    const bool own_size = is_depth && depth.width > 0;
    const cv::Size size(own_size ? depth.width : calibration_.camera.width,
                        own_size ? depth.height : calibration_.camera.height);
    streams_.push_back(std::make_unique<VideoStream>(path, std::move(device), is_depth, size, fps));
  }

  bool has_depth() const override { return streams_.size() > 1; }
  const RgbdCalibration& calibration() const override { return calibration_; }
  const std::string& calibration_source() const override { return calibration_source_; }

  std::optional<LivePicture> next(std::chrono::milliseconds wait) override {
    std::optional<LivePicture> picture = take();
    if (picture) return picture;
    std::vector<pollfd> awaited;
    for (const auto& stream : streams_) awaited.push_back({stream->descriptor(), POLLIN, 0});
    ::poll(awaited.data(), awaited.size(), static_cast<int>(wait.count()));
    return take();
  }

 private:
  // In turn, so that neither stream starves the other.
  std::optional<LivePicture> take() {
    for (std::size_t i = 0; i < streams_.size(); ++i) {
      turn_ = (turn_ + 1) % streams_.size();
      if (std::optional<LivePicture> picture = streams_[turn_]->take()) return picture;
    }
    return std::nullopt;
  }

  RgbdCalibration calibration_;
  std::string calibration_source_;
  std::vector<std::unique_ptr<VideoStream>> streams_;  // colour, depth
  std::size_t turn_ = 0;
};

}  // namespace

std::unique_ptr<LiveCamera> open_v4l2(const SourceName& name, const std::string& calibration,
                                      const OpenVideoDevice& open) {
  constexpr double kFastest = 1000.0;
  name.require_options({"fps"});
  const double fps = name.number("fps", 1.0, kFastest).value_or(0.0);
  const std::vector<std::string>& places = name.places();
  if (places.empty() || places.size() > 2) {
    throw InputError(
        fmt::format("{}: {} devices, expected v4l2:COLOUR,DEPTH such as "
                    "v4l2:/dev/video4,/dev/video2",
                    name.text(), places.size()));
  }
  if (calibration.empty()) {
    throw InputError(name.text() +
                     ": video devices do not say how they are calibrated, expected --calibration "
                     "with a preset or a YAML file");
  }
  auto camera = std::make_unique<V4l2Camera>(load_calibration(calibration), calibration);
  for (const std::string& path : places) camera->add(path, open(path), fps);
  return camera;
}

}  // namespace dxslam
