// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "core/frame.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace dxslam {
namespace {

constexpr auto kNearest = static_cast<float>(Camera::kNearest);
// Sigma of the keypoint (docs/experiments.md).
constexpr double kMaxDisparityError = 4.0;
constexpr float kSameSurface = 0.02F;  // neighbours within 2 % of depth belong to one surface

float depth_at(const cv::Mat& depth, float x, float y, double max_depth) {
  const int nearest_x = static_cast<int>(std::lround(x));
  const int nearest_y = static_cast<int>(std::lround(y));
  if (nearest_x < 0 || nearest_y < 0 || nearest_x >= depth.cols || nearest_y >= depth.rows)
    return 0;
  const float nearest = depth.at<float>(nearest_y, nearest_x);
  if (!(nearest > kNearest) || nearest > static_cast<float>(max_depth)) return 0.0F;

  const int x0 = static_cast<int>(std::floor(x));
  const int y0 = static_cast<int>(std::floor(y));
  if (x0 < 0 || y0 < 0 || x0 + 1 >= depth.cols || y0 + 1 >= depth.rows) return nearest;
  const float fx = x - static_cast<float>(x0);
  const float fy = y - static_cast<float>(y0);
  const float weights[4] = {(1 - fx) * (1 - fy), fx * (1 - fy), (1 - fx) * fy, fx * fy};
  // Disparity, not depth, is linear over a plane.
  float inverse = 0.0F;
  for (int k = 0; k < 4; ++k) {
    const float d = depth.at<float>(y0 + k / 2, x0 + k % 2);
    if (!(std::abs(d - nearest) < kSameSurface * nearest)) return nearest;
    inverse += weights[k] / d;
  }
  return 1.0F / inverse;
}

void check_inputs(const RgbdImage& image, const Features& features, const Camera& camera) {
  require(image.color.empty() ||
              (image.color.cols == camera.width && image.color.rows == camera.height),
          "colour image must have the size of the camera");
  require(image.depth.empty() || image.depth.type() == CV_32FC1,
          "depth image must be CV_32FC1 metres");
  require(image.depth.empty() ||
              (image.depth.cols == camera.width && image.depth.rows == camera.height),
          "depth image must have the size of the camera");
  require(features.descriptors.rows == static_cast<int>(features.size()),
          "there must be one descriptor row per keypoint");
  require(features.size() == 0 || features.descriptors.type() == CV_32FC1 ||
              features.descriptors.type() == CV_8UC1,
          "descriptors must be CV_32FC1 or CV_8UC1");
}

}  // namespace

int Frame::depth_count() const {
  return static_cast<int>(
      std::count_if(depths.begin(), depths.end(), [](float depth) { return depth > 0.0F; }));
}

cv::Mat rows_of(const cv::Mat& descriptors, const std::vector<int>& rows) {
  if (static_cast<int>(rows.size()) == descriptors.rows) return descriptors;
  cv::Mat kept(static_cast<int>(rows.size()), descriptors.cols, descriptors.type());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    descriptors.row(rows[i]).copyTo(kept.row(static_cast<int>(i)));
  }
  return kept;
}

FramePtr make_frame(const RgbdImage& image, const Features& features, const Camera& camera) {
  check_inputs(image, features, camera);
  auto frame = std::make_shared<Frame>();
  frame->index = image.index;
  frame->stamp = image.stamp;
  frame->global = features.global;
  frame->encoder = features.encoder;
  const std::size_t n = features.size();
  frame->pixels.reserve(n);
  frame->depths.reserve(n);
  frame->scores.reserve(n);
  frame->sigmas.reserve(n);
  std::vector<int> rows;
  rows.reserve(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Keypoint& k = features.keypoints[i];
    const std::optional<Eigen::Vector2d> pixel = camera.undistort({k.x, k.y});
    if (!pixel) continue;
    rows.push_back(static_cast<int>(i));
    frame->pixels.push_back(pixel->cast<float>());
    frame->depths.push_back(
        image.depth.empty() ? 0.0F : depth_at(image.depth, k.x, k.y, camera.max_depth));
    frame->scores.push_back(k.score);
    frame->sigmas.push_back(k.sigma * static_cast<float>(camera.stretch(*pixel)));
  }
  frame->descriptors = rows_of(features.descriptors, rows);
  return frame;
}

bool Measurement::disparity_agrees(const Camera& camera, double z) const {
  if (z <= Camera::kNearest) return false;
  return std::abs(disparity - camera.bf() / z) <= kMaxDisparityError * sigma;
}

Measurement measurement_of(const Frame& frame, std::size_t keypoint, const Camera& camera) {
  Measurement m;
  m.pixel = frame.pixels[keypoint].cast<double>();
  m.sigma = static_cast<double>(frame.sigmas[keypoint]);
  if (frame.has_depth(keypoint)) {
    m.disparity = camera.bf() / static_cast<double>(frame.depths[keypoint]);
  }
  return m;
}

Measurement measurement_of(const Frame& frame, std::size_t keypoint, const Camera& camera,
                           double z) {
  Measurement m = measurement_of(frame, keypoint, camera);
  if (!m.disparity_agrees(camera, z)) m.drop_disparity();
  return m;
}

}  // namespace dxslam
