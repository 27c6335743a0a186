// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <opencv2/core.hpp>
#include <random>
#include <vector>

namespace dxslam {

struct Clustering {
  cv::Mat centres;         ///< one row a cluster, as descriptors are: of unit L2 norm, or bytes
  std::vector<int> label;  ///< cluster of each row
};

/// Divides the rows of `descriptors` (CV_32F of unit L2 norm, or CV_8U) into at most `k` clusters,
/// none of them empty, by k-means from k-means++ seeds; row i counts `weight[i]` times (all once
/// where it is empty). Each row belongs to the cluster of the nearest centre. There are fewer than
/// `k` clusters where there are fewer distinct rows.
Clustering cluster_descriptors(const cv::Mat& descriptors, const std::vector<float>& weight, int k,
                               int iterations, std::mt19937_64& random);

}  // namespace dxslam
