// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "core/camera.h"
#include "core/sequence.h"

namespace dxslam {

/// What the first depth images of a source (CV_32FC1 metres) tell: median_depth and depth_share.
void survey_depths(const std::vector<cv::Mat>& images, RecordingFacts& facts);
/// Throws InputError if that median is not one of a scene (0.05 to 30 m): the depth factor is
/// wrong.
void check_depth_scale(const std::string& name, const Camera& camera, const RecordingFacts& facts);

}  // namespace dxslam
