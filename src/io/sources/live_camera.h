// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <chrono>
#include <cstddef>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "io/calibration/calibration.h"

namespace dxslam {

/// A picture as a driver gives it.
struct LivePicture {
  bool is_depth = false;
  double stamp = 0.0;  ///< when it was taken, seconds since 1970
  cv::Mat image;       ///< CV_8UC3 (BGR) or CV_8UC1; depth: CV_16UC1 raw units
  /// Why it cannot be used, if so; then there is no image.
  std::string problem;
};

/// A kind of camera, one file each (v4l2_camera.h); what they have in common is in live_source.h.
/// Pictures come from construction on. One thread at a time.
class LiveCamera {
 public:
  virtual ~LiveCamera() = default;
  virtual bool has_depth() const = 0;
  /// How colour and depth are seen, and the file or device that says so.
  virtual const RgbdCalibration& calibration() const = 0;
  virtual const std::string& calibration_source() const = 0;
  /// The next picture of either kind; nothing if none came within `wait`. Throws InputError where
  /// none can come any more: the camera was unplugged.
  virtual std::optional<LivePicture> next(std::chrono::milliseconds wait) = 0;
};

/// The name of a live source: "v4l2:/dev/video2,/dev/video4?fps=30".
class SourceName {
 public:
  /// Throws InputError for what has no such form.
  explicit SourceName(const std::string& text);

  const std::string& text() const { return text_; }
  const std::string& kind() const { return kind_; }
  const std::vector<std::string>& places() const { return places_; }
  /// Throws InputError, naming the nearest that is known, if an option is none of these.
  void require_options(const std::vector<std::string>& known) const;
  std::optional<double> number(const std::string& option, double min, double max) const;

 private:
  std::optional<std::string> value(const std::string& option) const;

  std::string text_;
  std::string kind_;
  std::vector<std::string> places_;
  std::vector<std::pair<std::string, std::string>> options_;
};

}  // namespace dxslam
