// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>

#include "core/camera.h"
#include "synthetic/renderer.h"

namespace dxslam {

/// Radiance (CV_32FC3, linear) to an image (CV_8UC3) with gamma 1 / 2.2 and Gaussian noise of
/// 1.5 * noise grey levels.
cv::Mat develop_image(const cv::Mat& radiance, double gain, double noise, std::uint64_t seed);

/// What a structured-light sensor of baseline 0.075 m reads of a rendering, CV_32FC1 metres on the
/// grid of camera.depth_factor, 0 where there is no reading. Noise and steps (1/8 pixel) are even
/// in the disparity of a 525-pixel camera, hence grow with the square of the depth (about 2 mm at 1
/// m). Without reading are: places the projector does not see beside near edges, grazing surfaces,
/// depths beyond 0.35 to 8 m, and some pixels at depth edges. At strength 0 depth is perfect up to
/// camera.max_depth.
cv::Mat measure_depth(const Rendering& rendering, const Camera& camera, double strength,
                      std::uint64_t seed);

}  // namespace dxslam
