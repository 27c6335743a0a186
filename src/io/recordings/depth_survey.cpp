// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/recordings/depth_survey.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "core/error.h"

namespace dxslam {
namespace {

constexpr double kNearestScene = 0.05;    // metres, least plausible median depth
constexpr double kFarthestScene = 30.0;   // metres, largest plausible median depth
constexpr double kEnoughReadings = 0.01;  // share of pixels below which a median says nothing

}  // namespace

void survey_depths(const std::vector<cv::Mat>& images, RecordingFacts& facts) {
  std::vector<float> depths;
  std::size_t pixels = 0;
  for (const cv::Mat& image : images) {
    pixels += image.total();
    for (int row = 0; row < image.rows; ++row) {
      const float* line = image.ptr<float>(row);
      std::copy_if(line, line + image.cols, std::back_inserter(depths),
                   [](float metres) { return metres > 0.0F; });
    }
  }
  if (depths.empty()) return;
  facts.depth_share = static_cast<double>(depths.size()) / static_cast<double>(pixels);
  const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
  std::nth_element(depths.begin(), middle, depths.end());
  facts.median_depth = *middle;
}

void check_depth_scale(const std::string& name, const Camera& camera, const RecordingFacts& facts) {
  if (facts.depth_share < kEnoughReadings) return;
  if (facts.median_depth >= kNearestScene && facts.median_depth <= kFarthestScene) return;
  throw InputError(fmt::format(
      "{}: median depth of the first images is {:.3g} m with depth_factor {} of {}, expected {} "
      "to {} m: the factor must be the raw value of one metre",
      name, facts.median_depth, camera.depth_factor, facts.calibration_source, kNearestScene,
      kFarthestScene));
}

}  // namespace dxslam
