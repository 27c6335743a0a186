// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <functional>
#include <opencv2/core.hpp>
#include <vector>

#include "vocabulary/training_options.h"
#include "vocabulary/vocabulary_tree.h"

namespace dxslam {

/// Share of the work done, 0 to 1.
using TrainingProgress = std::function<void(double)>;

/// Clusters descriptors into a tree whose leaves are words, each node into `branching` children:
/// the largest leaf is divided again and again until there are `words` leaves (0: no limit), all
/// are single descriptors, or lie at `depth` (0: no limit). Without limits every distinct row is a
/// word, and parents group the words below them. Row i counts `weight[i]` times (all once where
/// empty). Uses branching, depth, words, iterations and seed of the options; weights of the words
/// are 1. Throws ContractError without descriptors.
VocabularyTree grow_word_tree(const cv::Mat& descriptors, const std::vector<float>& weight,
                              const VocabularyTrainingOptions& options,
                              const TrainingProgress& progress = {});

/// Sets the weight of each word to its inverse document frequency, ln((1 + N) / (1 + n)), where n
/// of the N images have the word. One element of `images` is one image's descriptors.
void weigh_words(VocabularyTree& tree, const std::vector<cv::Mat>& images);

}  // namespace dxslam
