// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <memory>
#include <opencv2/core.hpp>
#include <vector>

#include "core/camera.h"
#include "core/features.h"
#include "core/rig.h"

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
  CameraId camera = 0;  ///< in the rig of the map that the frame belongs to
  std::int64_t index = 0;
  double stamp = 0.0;                   ///< seconds
  std::vector<Eigen::Vector2f> pixels;  ///< N undistorted positions
  std::vector<float> depths;            ///< N metres; 0 where there is no reading
  std::vector<float> scores;            ///< N detector confidences
  std::vector<float> sigmas;            ///< N undistorted pixels, standard deviations
  cv::Mat descriptors;                  ///< N x D, as in Features
  std::vector<float> global;            ///< as in Features
  cv::Mat encoder;                      ///< as in Features; dropped once it has served

  std::size_t size() const { return pixels.size(); }
  bool has_depth(std::size_t i) const { return depths[i] > 0.0F; }
  int depth_count() const;
};

using FramePtr = std::shared_ptr<const Frame>;

/// These rows of descriptors, rising; shared with `descriptors` where they are all.
cv::Mat rows_of(const cv::Mat& descriptors, const std::vector<int>& rows);

/// What an image says of a point of the scene: the one form in which the optimisers take it. A
/// depth is a disparity here, which has the same deviation as the pixel (Camera::bf). Plain data.
struct Measurement {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  ///< undistorted
  double sigma = 1.0;                               ///< of pixel and disparity, pixels
  double disparity = 0.0;                           ///< pixels; see has_disparity()

  bool has_disparity() const { return disparity > 0.0; }
  void drop_disparity() { disparity = 0.0; }
  /// Whether all numbers can be used.
  bool is_finite() const {
    return pixel.allFinite() && std::isfinite(disparity) && sigma > 0.0 && std::isfinite(sigma);
  }
  /// Whether the disparity is that of a point `z` metres ahead. A depth reading beside an edge is
  /// often that of another surface, while the pixel is right: then the pixel alone is to be used.
  bool disparity_agrees(const Camera& camera, double z) const;
};

/// Of a keypoint of the frame, which `camera` took; with its disparity where it has a depth.
Measurement measurement_of(const Frame& frame, std::size_t keypoint, const Camera& camera);
/// The same of a keypoint that is taken for a point `z` metres ahead: without a disparity that
/// disagrees.
Measurement measurement_of(const Frame& frame, std::size_t keypoint, const Camera& camera,
                           double z);

/// Undistorts the keypoints and reads their depth: bilinear over the four neighbours where these
/// agree, else the nearest pixel's reading, so that no depth is invented across an edge. Readings
/// nearer than Camera::kNearest count as missing. Keypoints in directions that are not used
/// (Camera::undistort) are left out. Throws ContractError if colour, depth or
/// descriptors do not fit the camera or each other; `color` may be empty.
FramePtr make_frame(const RgbdImage& image, const Features& features, const Camera& camera);

}  // namespace dxslam
