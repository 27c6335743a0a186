// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <opencv2/core.hpp>

#include "vocabulary/fbow_image.h"

namespace dxslam {

/// Descends with each row of `descriptors` (of the image's kind and dimension) to the nearest child
/// at each level: squared L2 distance, or differing bits; the first of equals. `found` has one
/// place a row, and gets the leaf. Vectorised by run-time dispatch.
void search_words(const FbowImage& image, const cv::Mat& descriptors, FbowImage::Child* found);

}  // namespace dxslam
