// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <opencv2/core.hpp>
#include <vector>

#include "core/camera.h"
#include "core/features.h"

namespace dxslam {

/// One image pair as a camera or a reader gives it. Images are shared, never written to.
struct RgbdImage {
  std::int64_t index = 0;  ///< position in the sequence
  double stamp = 0.0;      ///< seconds
  cv::Mat color;           ///< CV_8UC3 (BGR) or CV_8UC1
  cv::Mat depth;           ///< CV_32FC1 metres, registered to colour; 0 where there is no reading
};

/// What tracking sees of one image: keypoints with depth. Immutable once made; shared between
/// threads as std::shared_ptr<const Frame>.
struct Frame {
  std::int64_t index = 0;
  double stamp = 0.0;                   ///< seconds
  std::vector<Eigen::Vector2f> pixels;  ///< N undistorted positions
  std::vector<float> depths;            ///< N metres; 0 where there is no reading
  std::vector<float> scores;            ///< N detector confidences
  std::vector<float> sigmas;            ///< N pixels
  cv::Mat descriptors;                  ///< N x D, as in Features
  std::vector<float> global;            ///< as in Features
  cv::Mat encoder;                      ///< as in Features; dropped once it has served

  std::size_t size() const { return pixels.size(); }
  bool has_depth(std::size_t i) const { return depths[i] > 0.0F; }
};

using FramePtr = std::shared_ptr<const Frame>;

/// Disparity (see Camera::bf) of a keypoint for the optimisers; 0 where it has no depth.
double disparity_of(const Frame& frame, std::size_t keypoint, const Camera& camera);

/// Whether a disparity is that of a point `z` metres ahead, by the `sigma` of its keypoint. A depth
/// reading beside an edge is often that of another surface, while the pixel is right: then the
/// optimisers are to go by the pixel alone.
bool disparity_agrees(const Camera& camera, double disparity, double z, double sigma);

/// disparity_of() a keypoint that is taken for a point `z` metres ahead; 0 where it disagrees.
double agreeing_disparity(const Frame& frame, std::size_t keypoint, const Camera& camera, double z);

/// Undistorts the keypoints and reads their depth: bilinear over the four neighbours where these
/// agree, else the nearest pixel's reading, so that no depth is invented across an edge. Readings
/// nearer than Camera::kNearest count as missing. Throws ContractError if colour, depth or
/// descriptors do not fit the camera or each other; `color` may be empty.
FramePtr make_frame(const RgbdImage& image, const Features& features, const Camera& camera);

}  // namespace dxslam
