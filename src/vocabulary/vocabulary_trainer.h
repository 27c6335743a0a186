// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/features.h"
#include "vocabulary/descriptor_mean.h"
#include "vocabulary/image_sample.h"
#include "vocabulary/training_options.h"
#include "vocabulary/vocabulary.h"
#include "vocabulary/word_tree.h"

namespace dxslam {

/// Trains a vocabulary from images one by one, in bounded memory (paper III.C).
///
/// incremental: descriptors of each image are matched with those of the image before. A matched one
/// joins the word of its match if it is among the best by keypoint score; an unmatched one opens
/// a new word. At the end words are grouped into parents up to the root; if there
/// are more than `words`, the lowest groups take the place of their members.
/// kmeans: hierarchical k-means over the descriptors of a sample of the images (the paper's
/// "no-incre").
///
/// One thread at a time. Deterministic.
class VocabularyTrainer {
 public:
  /// Throws InputError if an option is out of range.
  VocabularyTrainer(const DescriptorTraits& traits, const VocabularyTrainingOptions& options);

  /// The next image, a neighbour of the one before unless start_sequence() was called. Throws
  /// ContractError if its descriptors do not fit the traits.
  void add(const Features& features);
  void start_sequence();

  std::size_t images() const { return images_; }
  /// Words that are open at the moment (incremental).
  std::size_t open_words() const { return words_.size(); }

  /// The vocabulary from all images until now; may be called more than once. Throws InputError if
  /// they have too few features.
  Vocabulary finish(const std::string& name, const TrainingProgress& progress = {}) const;

  /// Writes all state to a file that load() continues from. `source` says what is trained from
  /// what, with which options; `position` is the caller's own count of images. Throws InputError if
  /// the file cannot be written.
  void save(const std::string& path, const std::string& source, std::uint64_t position) const;
  /// Replaces the state by that of a file, and returns the position. Throws InputError if the file
  /// is damaged or was written for another `source`.
  std::uint64_t load(const std::string& path, const std::string& source);

 private:
  void join_words(const Features& features);
  void forget_rare_words();
  // Centres of the open words that enough images have joined.
  cv::Mat lasting_words() const;

  DescriptorTraits traits_;
  VocabularyTrainingOptions options_;
  std::size_t images_ = 0;
  ImageSample sample_;
  DescriptorMeans words_;                  // members of each open word
  cv::Mat last_descriptors_;               // of the image before; empty at the start of a sequence
  std::vector<std::uint32_t> last_words_;  // word of each of them
};

}  // namespace dxslam
