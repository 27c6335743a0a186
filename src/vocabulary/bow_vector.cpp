// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "vocabulary/bow_vector.h"

#include <algorithm>

namespace dxslam {

// Words that only one image has add |v| + 0 - |v| = 0, so the common ones are enough; and for
// entries that are not negative, a + b - |a - b| is 2 min(a, b).
double bow_score(const BowVector& a, const BowVector& b) {
  double sum = 0.0;
  auto left = a.words.begin();
  auto right = b.words.begin();
  while (left != a.words.end() && right != b.words.end()) {
    if (left->first < right->first) {
      ++left;
    } else if (right->first < left->first) {
      ++right;
    } else {
      sum += std::min(left->second, right->second);
      ++left;
      ++right;
    }
  }
  return 2.0 * sum;
}

BowVector make_bow_vector(std::vector<std::pair<WordId, float>> entries) {
  std::sort(entries.begin(), entries.end());
  BowVector vector;
  double total = 0.0;
  for (const auto& [word, weight] : entries) {
    if (!(weight > 0.0F)) continue;
    total += weight;
    if (!vector.words.empty() && vector.words.back().first == word) {
      vector.words.back().second += weight;
    } else {
      vector.words.emplace_back(word, weight);
    }
  }
  for (auto& entry : vector.words) entry.second = static_cast<float>(entry.second / total);
  return vector;
}

}  // namespace dxslam
