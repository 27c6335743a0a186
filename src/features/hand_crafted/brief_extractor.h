// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <memory>
#include <string>

#include "features/extractor.h"

namespace dxslam {

/// Keypoints and global descriptor of `detector` with BRIEF descriptors: the X+BRIEF combinations
/// of the paper's comparison. Upright, or turned with the local brightness where `oriented`.
std::unique_ptr<FeatureExtractor> make_brief_extractor(std::unique_ptr<FeatureExtractor> detector,
                                                       bool oriented);

}  // namespace dxslam
