// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstddef>
#include <memory>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "vocabulary/bow_vector.h"

namespace dxslam {

struct VocabularyTree;
struct FbowImage;

/// What a vocabulary is, for people.
struct VocabularyInfo {
  std::string name;       ///< as the file has it; DBoW2 files have none
  bool binary = false;    ///< bytes compared by Hamming distance, else floats by L2 distance
  int dimension = 0;      ///< floats, or bytes where binary
  int branching = 0;      ///< most children of a node
  int depth = 0;          ///< steps from the root to the farthest word
  std::size_t words = 0;  ///< leaves
  std::size_t inner_nodes = 0;
  std::size_t bytes = 0;       ///< of the tree in memory, mapped or not
  bool mapped = false;         ///< the tree is the file itself, mapped into memory
  bool has_checksum = false;   ///< the file carried one (and it was right)
  bool distinct_words = true;  ///< no two leaves have the same word id
  float min_weight = 0.0F;     ///< of a word
  float max_weight = 0.0F;
};

/// Tree of visual words (paper III.C): turns descriptors into words by descending to the nearest
/// child at each level, and images into histograms of words. Immutable; copies share the tree, and
/// any number of threads may use it.
class Vocabulary {
 public:
  /// Reads an FBoW file (mapped into memory, not copied) or a DBoW2 text file, told apart by
  /// content. Throws InputError, one sentence with the file and what was expected, for a file that
  /// is no vocabulary, is cut short, or points outside of itself. A mapped file must not be
  /// overwritten in place; replacing it by renaming (as save() does) is safe.
  static Vocabulary load(const std::string& path);

  /// Throws ContractError for a tree that is none (see vocabulary_tree.h).
  static Vocabulary from_tree(const VocabularyTree& tree);

  /// Throws InputError if nothing could be written to `path`, or if what is there is no vocabulary,
  /// which a mistyped name must not cost. Changes nothing.
  static void require_target(const std::string& path);

  /// Writes an FBoW file. Throws InputError if it cannot be written.
  void save(const std::string& path) const;

  /// The tree as separate nodes, for writers of other formats.
  VocabularyTree tree() const;

  /// Word of each row of `descriptors` (N x D, CV_32F or CV_8U). Throws ContractError if these are
  /// not of the vocabulary's kind and dimension.
  std::vector<WordId> words(const cv::Mat& descriptors) const;

  /// Histogram of the words of all rows, by tf-idf; empty for no rows. Throws as words() does.
  BowVector transform(const cv::Mat& descriptors) const;

  /// True if rows of `descriptors` can be quantised: kind and dimension agree, or there are none.
  bool fits(const cv::Mat& descriptors) const;

  const std::string& name() const;  ///< as the file has it; may be empty
  std::size_t word_count() const;   ///< leaves
  WordId word_limit() const;        ///< all word ids are below it; word_count() in own files
  bool binary() const;
  int dimension() const;         ///< floats, or bytes where binary
  int descriptor_bytes() const;  ///< of one descriptor

  /// Walks through the whole tree.
  VocabularyInfo info() const;

 private:
  explicit Vocabulary(std::shared_ptr<const FbowImage> image);
  std::shared_ptr<const FbowImage> image_;
};

/// The name of a vocabulary that was trained on the descriptors of an extractor by a method
/// (training_options.h).
std::string trained_name(const std::string& features, const std::string& method);

/// Throws InputError unless the words of the vocabulary, read from the file `path`, are of
/// descriptors of this kind, and, where its name says what features it was trained on, of those of
/// the extractor `features`.
void require_words_of(const Vocabulary& vocabulary, const std::string& path,
                      const std::string& features, bool binary, int dimension);

}  // namespace dxslam
