// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <string>

#include "core/options.h"

namespace dxslam {

/// How a vocabulary is trained (paper III.C).
struct VocabularyTrainingOptions {
  std::string method = "incremental";  ///< incremental (the paper's) or kmeans ("no-incre")
  int branching = 10;
  int depth = 0;
  int words = 10000;
  int matched_per_image = 300;
  double match_ratio = 0.9;
  int min_observations = 2;
  int max_open_words = 200000;
  int sample_mb = 256;
  int iterations = 12;
  int seed = 1;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit("method", self.method, "", "incremental or kmeans");
    visit("branching", self.branching, {2, 256}, "children", "most children of a node of the tree");
    visit("depth", self.depth, {0, 64}, "levels",
          "most steps from the root to a word; 0 = as many as the words need");
    visit("words", self.words, {0, 10000000}, "words",
          "most words; 0 = all (incremental), or as many as branching and depth allow (kmeans)");
    visit("matched_per_image", self.matched_per_image, {1, 100000}, "descriptors",
          "of the matched descriptors of an image the best by score join their words");
    visit("match_ratio", self.match_ratio, {0.1, 1}, "",
          "largest distance of matched descriptors over that of the second nearest; 1 = any");
    visit("min_observations", self.min_observations, {1, 1000}, "images",
          "words that fewer images have joined are left out");
    visit("max_open_words", self.max_open_words, {1000, 100000000}, "words",
          "beyond it the words seen least are forgotten while training");
    visit("sample_mb", self.sample_mb, {1, 1000000}, "MB",
          "memory for whole images, evenly over the training, for idf and kmeans");
    visit("iterations", self.iterations, {1, 1000}, "rounds", "of clustering, at most");
    visit("seed", self.seed, {0, 2147483647}, "", "seed of the clustering");
  }
};

}  // namespace dxslam
