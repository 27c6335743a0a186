// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "vocabulary/bow_vector.h"

namespace dxslam {

/// A tree of words as separate nodes: what trainers and text files make, before it is packed into a
/// Vocabulary.
struct VocabularyTree {
  struct Node {
    std::uint32_t parent = 0;             ///< index of a node; the root has itself
    std::vector<std::uint32_t> children;  ///< indices of nodes; a node without any is a word
    WordId word = 0;                      ///< of words only
    float weight = 0.0F;                  ///< of words only: the idf
  };

  std::string name;         ///< at most 49 bytes are kept
  int branching = 0;        ///< most children of a node, 2 to 65535
  std::vector<Node> nodes;  ///< the root first
  /// nodes.size() x D, CV_32F or CV_8U, continuous: the descriptor each node stands for; that of
  /// the root is not used.
  cv::Mat descriptors;

  bool is_word(std::size_t node) const { return nodes[node].children.empty(); }
};

/// Throws ContractError unless the root has children, each other node is the child of exactly its
/// parent, no node has more than `branching` children, and descriptors, word ids (below the number
/// of words) and weights (finite, not negative) are in order.
void check_tree(const VocabularyTree& tree);

/// Gives words the ids 0, 1, ... in the order of their nodes.
void number_words(VocabularyTree& tree);

}  // namespace dxslam
