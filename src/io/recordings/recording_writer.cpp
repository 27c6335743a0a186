// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/recordings/recording_writer.h"

#include <fmt/format.h>

#include <filesystem>
#include <limits>
#include <opencv2/core.hpp>

#include "core/error.h"
#include "io/recordings/recording_formats.h"

namespace dxslam {
namespace {

namespace fs = std::filesystem;

void require_free(const std::string& path, bool is_file) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) return;
  const bool fits = is_file ? fs::is_regular_file(status) : fs::is_directory(status);
  if (fits && fs::is_empty(path, error)) return;
  throw InputError(fmt::format("{}: is there already, expected the name of a new recording", path));
}

}  // namespace

std::unique_ptr<RecordingWriter> create_recording(const std::string& path,
                                                  const ImageOrigin& origin) {
  const std::string ending = fs::path(path).extension().string();
  for (const char* other : {".bag", ".db3", ".mp4", ".zip"}) {
    if (ending != other) continue;
    throw InputError(fmt::format(
        "{}: recordings are written as MCAP or into a folder, expected a name that ends in .mcap "
        "or that of a folder",
        path));
  }
  const bool is_file = ending == ".mcap";
  require_free(path, is_file);
  const fs::path parent = fs::absolute(path).parent_path();
  if (is_file && !fs::is_directory(parent)) {
    throw InputError(fmt::format("{}: no folder {}, expected one", path, parent.string()));
  }
  return is_file ? create_mcap_recording(path, origin) : create_tum_recording(path, origin);
}

cv::Mat raw_depth(const cv::Mat& metres, double factor, bool& exact) {
  require(metres.type() == CV_32FC1, "depth is CV_32FC1, metres");
  // Beyond that convertTo() would make it the farthest that 16 bits hold.
  const double farthest = std::numeric_limits<std::uint16_t>::max() / factor;
  cv::Mat near = metres;
  if (cv::Mat too_far = metres > farthest; cv::countNonZero(too_far) > 0) {
    near = metres.clone();
    near.setTo(0.0F, too_far);
  }
  cv::Mat raw;
  near.convertTo(raw, CV_16UC1, factor);
  cv::Mat back;
  raw.convertTo(back, CV_32F, 1.0 / factor);
  exact = cv::countNonZero(back != metres) == 0;
  return raw;
}

}  // namespace dxslam
