// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <opencv2/core.hpp>
#include <vector>

namespace dxslam {

/// Distance of two descriptor rows of the same kind: L2 of unit vectors (CV_32F, 0 to 2) or the
/// number of differing bits (CV_8U). Vectorised by run-time dispatch; no checks, as it is called
/// millions of times.
float descriptor_distance(const cv::Mat& a, int row_a, const cv::Mat& b, int row_b);

/// Similarities of rows of `a` with all rows of `b`: the dot product (CV_32F), or minus the number
/// of differing bits (CV_8U); larger is closer in both. For tables too large for the cache, a few
/// rows at a time. Refers to the data of `a` and `b`. One object may be used by several threads.
class DescriptorSimilarities {
 public:
  /// Throws ContractError if the two differ in type or dimension.
  DescriptorSimilarities(const cv::Mat& a, const cv::Mat& b);

  /// similarity[(i - first) * b.rows + j] of rows first to first + count - 1 of a.
  void of_rows(int first, int count, float* similarity) const;

 private:
  cv::Mat a_;
  cv::Mat b_;
  std::vector<float> panels_;
};

/// similarity[i * b.rows + j] of every pair of rows. `similarity` has a.rows * b.rows places.
/// Throws ContractError if the two differ in type or dimension.
void descriptor_similarities(const cv::Mat& a, const cv::Mat& b, float* similarity);

/// The distance that belongs to a similarity.
float distance_of_similarity(float similarity, bool binary);

}  // namespace dxslam
