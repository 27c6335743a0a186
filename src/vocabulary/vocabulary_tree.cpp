// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "vocabulary/vocabulary_tree.h"

#include <cmath>
#include <cstddef>

#include "core/error.h"

namespace dxslam {
namespace {

constexpr int kMaxBranching = 65535;

void check_descriptors(const VocabularyTree& tree) {
  const cv::Mat& rows = tree.descriptors;
  require(rows.type() == CV_32F || rows.type() == CV_8U,
          "descriptors of a tree must be floats or bytes");
  require(rows.cols > 0 && static_cast<std::size_t>(rows.rows) == tree.nodes.size(),
          "a tree must have one descriptor a node");
}

std::size_t check_links(const VocabularyTree& tree) {
  std::size_t words = 0;
  std::size_t children = 0;
  for (std::uint32_t i = 0; i < tree.nodes.size(); ++i) {
    const VocabularyTree::Node& node = tree.nodes[i];
    require(node.children.size() <= static_cast<std::size_t>(tree.branching),
            "a node has more children than the tree's branching factor");
    words += node.children.empty() ? 1 : 0;
    for (const std::uint32_t child : node.children) {
      // Parents before children: there can be no circle.
      require(child > i && child < tree.nodes.size() && tree.nodes[child].parent == i,
              "a child must come behind its parent and name it");
      ++children;
    }
  }
  require(children + 1 == tree.nodes.size(), "each node but the root must be a child once");
  return words;
}

}  // namespace

void check_tree(const VocabularyTree& tree) {
  require(tree.branching >= 1 && tree.branching <= kMaxBranching,
          "the branching factor of a tree must be 1 to 65535");
  require(!tree.nodes.empty() && !tree.is_word(0), "the root of a tree must have children");
  check_descriptors(tree);
  const std::size_t words = check_links(tree);
  for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
    if (!tree.is_word(i)) continue;
    const VocabularyTree::Node& node = tree.nodes[i];
    require(node.word < words, "word ids of a tree must be below the number of words");
    require(std::isfinite(node.weight) && node.weight >= 0.0F,
            "weights of words must be finite and not negative");
  }
}

void number_words(VocabularyTree& tree) {
  WordId next = 0;
  for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
    if (tree.is_word(i)) tree.nodes[i].word = next++;
  }
}

}  // namespace dxslam
