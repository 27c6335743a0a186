// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <opencv2/core.hpp>

namespace dxslam {

/// Distance of two descriptor rows of the same kind: L2 of unit vectors (CV_32F, 0 to 2) or the
/// number of differing bits (CV_8U). Vectorised by run-time dispatch; no checks, as it is called
/// millions of times.
float descriptor_distance(const cv::Mat& a, int row_a, const cv::Mat& b, int row_b);

/// similarity[i * b.rows + j] of every pair of rows: the dot product (CV_32F), or minus the number
/// of differing bits (CV_8U); larger is closer in both. `similarity` has a.rows * b.rows places.
/// Throws ContractError if the two differ in type or dimension.
void descriptor_similarities(const cv::Mat& a, const cv::Mat& b, float* similarity);

/// The distance that belongs to a similarity.
float distance_of_similarity(float similarity, bool binary);

}  // namespace dxslam
