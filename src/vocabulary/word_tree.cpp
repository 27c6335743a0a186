// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "vocabulary/word_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <random>
#include <set>

#include "core/error.h"
#include "vocabulary/descriptor_clustering.h"
#include "vocabulary/vocabulary.h"

namespace dxslam {
namespace {

// A leaf that may be divided, with the rows below it.
struct Leaf {
  std::uint32_t node = 0;
  int level = 0;
  std::vector<int> rows;

  // The queue's top is the largest, and of equals the first.
  bool operator<(const Leaf& other) const {
    return rows.size() != other.rows.size() ? rows.size() < other.rows.size() : node > other.node;
  }
};

class TreeGrower {
 public:
  TreeGrower(const cv::Mat& rows, const std::vector<float>& weight,
             const VocabularyTrainingOptions& options)
      : rows_(rows),
        weight_(weight),
        options_(options),
        random_(static_cast<std::uint64_t>(options.seed)),
        words_(options.words > 0 ? static_cast<std::size_t>(options.words)
                                 : std::numeric_limits<std::size_t>::max()) {
    tree_.branching = options.branching;
    tree_.nodes.emplace_back();
    tree_.descriptors = cv::Mat::zeros(1, rows.cols, rows.type());
    Leaf root;
    for (int i = 0; i < rows.rows; ++i) root.rows.push_back(i);
    open_.push(std::move(root));
  }

  VocabularyTree grow(const TrainingProgress& progress) {
    const double goal = static_cast<double>(std::min(words_, static_cast<std::size_t>(rows_.rows)));
    while (!open_.empty() && (leaves_ < words_ || tree_.nodes.size() == 1)) {
      const Leaf leaf = open_.top();
      open_.pop();
      const auto most_more = static_cast<std::size_t>(options_.branching - 1);
      divide(leaf, static_cast<int>(std::min(words_ - leaves_, most_more)) + 1);
      if (progress) progress(std::min(1.0, static_cast<double>(leaves_) / goal));
    }
    tree_.descriptors = tree_.descriptors.clone();
    number_words(tree_);
    return std::move(tree_);
  }

 private:
  void divide(const Leaf& leaf, int parts) {
    cv::Mat members(0, rows_.cols, rows_.type());
    members.reserve(leaf.rows.size());
    std::vector<float> weights;
    for (const int row : leaf.rows) {
      members.push_back(rows_.row(row));
      if (!weight_.empty()) weights.push_back(weight_[static_cast<std::size_t>(row)]);
    }
    const Clustering clusters =
        cluster_descriptors(members, weights, parts, options_.iterations, random_);
    if (clusters.centres.rows < 2 && leaf.node != 0) return;  // all the same: a word
    std::vector<Leaf> children(static_cast<std::size_t>(clusters.centres.rows));
    for (std::size_t i = 0; i < leaf.rows.size(); ++i) {
      children[static_cast<std::size_t>(clusters.label[i])].rows.push_back(leaf.rows[i]);
    }
    for (std::size_t c = 0; c < children.size(); ++c) {
      add_child(leaf, clusters.centres.row(static_cast<int>(c)), std::move(children[c]));
    }
    leaves_ += children.size() - 1;
  }

  void add_child(const Leaf& parent, const cv::Mat& centre, Leaf child) {
    child.node = static_cast<std::uint32_t>(tree_.nodes.size());
    child.level = parent.level + 1;
    tree_.nodes[parent.node].children.push_back(child.node);
    tree_.nodes.emplace_back();
    tree_.nodes.back().parent = parent.node;
    tree_.nodes.back().weight = 1.0F;
    // A single descriptor stands for itself, to the bit.
    tree_.descriptors.push_back(child.rows.size() == 1 ? rows_.row(child.rows.front()) : centre);
    const bool deepest = options_.depth > 0 && child.level >= options_.depth;
    if (child.rows.size() > 1 && !deepest) open_.push(std::move(child));
  }

  const cv::Mat& rows_;
  const std::vector<float>& weight_;
  const VocabularyTrainingOptions& options_;
  std::mt19937_64 random_;
  std::size_t words_;
  std::size_t leaves_ = 1;  // the root, until it is divided
  VocabularyTree tree_;
  std::priority_queue<Leaf> open_;
};

}  // namespace

VocabularyTree grow_word_tree(const cv::Mat& descriptors, const std::vector<float>& weight,
                              const VocabularyTrainingOptions& options,
                              const TrainingProgress& progress) {
  require(descriptors.rows > 0, "a tree of words needs descriptors");
  return TreeGrower(descriptors, weight, options).grow(progress);
}

void weigh_words(VocabularyTree& tree, const std::vector<cv::Mat>& images) {
  const Vocabulary vocabulary = Vocabulary::from_tree(tree);
  std::vector<std::size_t> images_with(vocabulary.word_limit(), 0);
  for (const cv::Mat& image : images) {
    const std::vector<WordId> words = vocabulary.words(image);
    for (const WordId word : std::set<WordId>(words.begin(), words.end())) ++images_with[word];
  }
  for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
    if (!tree.is_word(i)) continue;
    const auto n = static_cast<double>(images_with[tree.nodes[i].word]);
    tree.nodes[i].weight =
        static_cast<float>(std::log((1.0 + static_cast<double>(images.size())) / (1.0 + n)));
  }
}

}  // namespace dxslam
