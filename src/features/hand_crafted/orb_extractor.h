// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <memory>

#include "features/extractor.h"
#include "features/extractor_options.h"

namespace dxslam {

/// ORB by OpenCV: 1000 features on 8 levels of scale 1.2 unless options say otherwise; 256-bit
/// descriptors; a keypoint's sigma is its level's scale. OpenCV's own choice crowds the strongest
/// corners, so this takes all FAST corners at a low threshold and spreads the choice over each
/// level of the pyramid; `options.spread` sets how evenly.
std::unique_ptr<FeatureExtractor> make_orb_extractor(const ExtractorOptions& options);

/// OpenCV's ORB as it is: the reference of the time and matching benchmarks.
std::unique_ptr<FeatureExtractor> make_opencv_orb_extractor(const ExtractorOptions& options);

}  // namespace dxslam
