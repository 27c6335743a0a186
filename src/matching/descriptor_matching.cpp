// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "matching/descriptor_matching.h"

#include <limits>

#include "matching/descriptor_distance.h"

namespace dxslam {
namespace {

constexpr float kNone = -std::numeric_limits<float>::max();

struct Nearest {
  float best = kNone;
  float second = kNone;
  int index = -1;
};

Nearest nearest_in_row(const float* row, int n) {
  Nearest nearest;
  for (int j = 0; j < n; ++j) {
    if (row[j] <= nearest.second) continue;
    if (row[j] > nearest.best) {
      nearest.second = nearest.best;
      nearest.best = row[j];
      nearest.index = j;
    } else {
      nearest.second = row[j];
    }
  }
  return nearest;
}

}  // namespace

std::vector<Match> match_mutual(const cv::Mat& a, const cv::Mat& b, float max_distance,
                                float ratio) {
  std::vector<Match> matches;
  if (a.empty() || b.empty()) return matches;
  const std::size_t columns = static_cast<std::size_t>(b.rows);
  std::vector<float> similarity(static_cast<std::size_t>(a.rows) * columns);
  descriptor_similarities(a, b, similarity.data());

  std::vector<float> column_best(columns, kNone);
  std::vector<int> column_row(columns, -1);
  for (int i = 0; i < a.rows; ++i) {
    const float* row = similarity.data() + static_cast<std::size_t>(i) * columns;
    for (std::size_t j = 0; j < columns; ++j) {
      const bool better = row[j] > column_best[j];
      column_best[j] = better ? row[j] : column_best[j];
      column_row[j] = better ? i : column_row[j];
    }
  }
  const bool binary = a.depth() != CV_32F;
  for (int i = 0; i < a.rows; ++i) {
    const Nearest nearest =
        nearest_in_row(similarity.data() + static_cast<std::size_t>(i) * columns, b.rows);
    if (nearest.index < 0 || column_row[static_cast<std::size_t>(nearest.index)] != i) continue;
    const float distance = distance_of_similarity(nearest.best, binary);
    if (distance > max_distance) continue;
    if (nearest.second > kNone && ratio < 1.0F &&
        distance >= ratio * distance_of_similarity(nearest.second, binary)) {
      continue;
    }
    matches.push_back({i, nearest.index, distance});
  }
  return matches;
}

}  // namespace dxslam
