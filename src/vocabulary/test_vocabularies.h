// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

// For tests only: made-up descriptors and trees of them.

#include <cmath>
#include <opencv2/core.hpp>
#include <random>

#include "vocabulary/vocabulary_tree.h"
#include "vocabulary/word_tree.h"

namespace dxslam {

/// Rows of unit L2 norm in random directions, or random bytes.
inline cv::Mat random_descriptors(bool binary, int rows, int dimension, unsigned seed) {
  std::mt19937 random(seed);
  cv::Mat descriptors(rows, dimension, binary ? CV_8U : CV_32F);
  std::uniform_int_distribution<int> byte(0, 255);
  std::normal_distribution<float> normal;
  for (int i = 0; i < rows; ++i) {
    for (int d = 0; d < dimension; ++d) {
      if (binary) {
        descriptors.at<std::uint8_t>(i, d) = static_cast<std::uint8_t>(byte(random));
      } else {
        descriptors.at<float>(i, d) = normal(random);
      }
    }
    if (!binary) descriptors.row(i) /= cv::norm(descriptors.row(i));
  }
  return descriptors;
}

/// Copies of the rows, a little changed: by noise of this length, or this number of bits.
inline cv::Mat disturbed(const cv::Mat& rows, double amount, unsigned seed) {
  std::mt19937 random(seed);
  cv::Mat result = rows.clone();
  std::normal_distribution<float> normal(
      0.0F, static_cast<float>(amount / std::sqrt(static_cast<double>(rows.cols))));
  std::uniform_int_distribution<int> bit(0, rows.cols * 8 - 1);
  for (int i = 0; i < rows.rows; ++i) {
    if (rows.depth() == CV_8U) {
      for (int n = 0; n < static_cast<int>(amount); ++n) {
        const int b = bit(random);
        result.at<std::uint8_t>(i, b / 8) ^= static_cast<std::uint8_t>(1U << (b % 8));
      }
      continue;
    }
    for (int d = 0; d < rows.cols; ++d) result.at<float>(i, d) += normal(random);
    result.row(i) /= cv::norm(result.row(i));
  }
  return result;
}

/// A tree that has each row of `words` as a word, with weights that differ.
inline VocabularyTree test_tree(const cv::Mat& words, int branching = 5) {
  VocabularyTrainingOptions options;
  options.branching = branching;
  options.words = 0;
  VocabularyTree tree = grow_word_tree(words, {}, options);
  for (VocabularyTree::Node& node : tree.nodes) {
    if (node.children.empty()) node.weight = 0.5F + 0.25F * static_cast<float>(node.word % 7);
  }
  tree.name = "test";
  return tree;
}

}  // namespace dxslam
