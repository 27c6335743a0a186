// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

namespace dxslam {

/// Index of a visual word, below Vocabulary::word_limit().
using WordId = std::uint32_t;

/// An image as a histogram of visual words (paper III.C): how often each word occurs in it, times
/// the word's weight, scaled to a sum of 1.
struct BowVector {
  std::vector<std::pair<WordId, float>> words;  ///< by rising word, each once, all above 0

  bool empty() const { return words.empty(); }
};

/// Similarity of two images, s(v1, v2) = sum |v1_i| + |v2_i| - |v1_i - v2_i| (paper III.E): 0 where
/// they share no word, 2 where they are equal. Both vectors have rising words and no negative
/// entry.
double bow_score(const BowVector& a, const BowVector& b);

/// Sorts, adds up entries of the same word, drops those that are not above 0, and scales to sum 1.
BowVector make_bow_vector(std::vector<std::pair<WordId, float>> entries);

}  // namespace dxslam
