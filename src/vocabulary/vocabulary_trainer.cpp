// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "vocabulary/vocabulary_trainer.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include "core/error.h"
#include "core/options.h"
#include "io/primitives/atomic_file.h"
#include "matching/descriptor_matching.h"
#include "vocabulary/training_checkpoint.h"
#include "vocabulary/vocabulary_tree.h"

namespace dxslam {
namespace {

constexpr std::uint32_t kNoWord = std::numeric_limits<std::uint32_t>::max();
constexpr double kKeptShare = 0.75;  // of the most open words, when there are too many

// Words by falling number of members; of equals the older first.
std::vector<std::uint32_t> by_members(const DescriptorMeans& words) {
  std::vector<std::uint32_t> order(words.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return words.total(a) > words.total(b);
  });
  return order;
}

}  // namespace

VocabularyTrainer::VocabularyTrainer(const DescriptorTraits& traits,
                                     const VocabularyTrainingOptions& options)
    : traits_(traits),
      options_(options),
      sample_(static_cast<std::size_t>(options.sample_mb) << 20U),
      words_(traits.binary, traits.dimension) {
  validate_options("vocabulary", options);
  if (options.method != "incremental" && options.method != "kmeans") {
    throw InputError(
        fmt::format("vocabulary.method is '{}', expected incremental or kmeans", options.method));
  }
}

void VocabularyTrainer::add(const Features& features) {
  require(features.descriptors.rows == static_cast<int>(features.size()) &&
              (features.size() == 0 ||
               (features.descriptors.type() == (traits_.binary ? CV_8U : CV_32F) &&
                features.descriptors.cols == traits_.dimension)),
          "descriptors of an image must fit the traits they are trained with");
  ++images_;
  sample_.add(features.descriptors);
  if (options_.method == "incremental") join_words(features);
}

void VocabularyTrainer::start_sequence() {
  last_descriptors_.release();
  last_words_.clear();
}

void VocabularyTrainer::join_words(const Features& features) {
  const cv::Mat& descriptors = features.descriptors;
  std::vector<Match> matches = match_mutual(descriptors, last_descriptors_, traits_.max_distance,
                                            static_cast<float>(options_.match_ratio));
  const auto score = [&](const Match& m) { return features.keypoints[m.a].score; };
  std::stable_sort(matches.begin(), matches.end(),
                   [&](const Match& a, const Match& b) { return score(a) > score(b); });
  std::vector<std::uint32_t> word_of(features.size(), kNoWord);
  for (std::size_t i = 0; i < matches.size(); ++i) {
    // Those beyond the best still carry their word on to the next image.
    const std::uint32_t word = last_words_[static_cast<std::size_t>(matches[i].b)];
    word_of[static_cast<std::size_t>(matches[i].a)] = word;
    if (i < static_cast<std::size_t>(options_.matched_per_image)) {
      words_.add(word, descriptors, matches[i].a);
    }
  }
  for (std::size_t i = 0; i < word_of.size(); ++i) {
    if (word_of[i] != kNoWord) continue;
    word_of[i] = static_cast<std::uint32_t>(words_.open());
    words_.add(word_of[i], descriptors, static_cast<int>(i));
  }
  last_descriptors_ = descriptors.clone();
  last_words_ = std::move(word_of);
  if (words_.size() > static_cast<std::size_t>(options_.max_open_words)) forget_rare_words();
}

void VocabularyTrainer::forget_rare_words() {
  std::vector<char> kept(words_.size(), 0);
  for (const std::uint32_t word : last_words_) kept[word] = 1;
  auto room = static_cast<std::size_t>(kKeptShare * options_.max_open_words);
  for (const std::uint32_t word : by_members(words_)) {
    if (room == 0) break;
    kept[word] = 1;
    --room;
  }
  std::vector<std::uint32_t> groups;
  std::vector<std::uint32_t> new_number(words_.size(), kNoWord);
  for (std::uint32_t word = 0; word < kept.size(); ++word) {
    if (!kept[word]) continue;
    new_number[word] = static_cast<std::uint32_t>(groups.size());
    groups.push_back(word);
  }
  words_.keep(groups);
  for (std::uint32_t& word : last_words_) word = new_number[word];
}

cv::Mat VocabularyTrainer::lasting_words() const {
  const cv::Mat means = words_.means();
  cv::Mat rows;
  for (std::size_t word = 0; word < words_.size(); ++word) {
    if (words_.total(word) < static_cast<float>(options_.min_observations)) continue;
    rows.push_back(means.row(static_cast<int>(word)));
  }
  return rows;
}

Vocabulary VocabularyTrainer::finish(const std::string& name,
                                     const TrainingProgress& progress) const {
  const cv::Mat rows = options_.method == "kmeans" ? sample_.all_rows() : lasting_words();
  if (rows.rows < 2) {
    throw InputError(
        fmt::format("{} images gave {} words, expected at least 2; are they of one "
                    "sequence, and is there anything to see?",
                    images_, rows.rows));
  }
  VocabularyTree tree = grow_word_tree(rows, {}, options_, progress);
  weigh_words(tree, sample_.images());
  tree.name = name;
  return Vocabulary::from_tree(tree);
}

void VocabularyTrainer::save(const std::string& path, const std::string& source,
                             std::uint64_t position) const {
  TrainingCheckpoint state;
  state.source = source;
  state.position = position;
  state.images = images_;
  state.sums = words_.sums();
  state.totals = words_.totals();
  state.last_words = last_words_;
  state.last_descriptors = last_descriptors_;
  state.sample = sample_.images();
  state.sample_stride = sample_.stride();
  state.sample_offered = sample_.offered();
  write_file_atomically(path, format_checkpoint(state));
}

std::uint64_t VocabularyTrainer::load(const std::string& path, const std::string& source) {
  const int type = traits_.binary ? CV_8U : CV_32F;
  TrainingCheckpoint state = read_checkpoint(path, type, traits_.dimension);
  if (state.source != source) {
    throw InputError(fmt::format("{}: was written by a training '{}', expected '{}'", path,
                                 state.source, source));
  }
  const auto known = [&](std::uint32_t word) { return word < state.totals.size(); };
  if (state.sums.size() != state.totals.size() * words_.width() ||
      state.last_words.size() != static_cast<std::size_t>(state.last_descriptors.rows) ||
      !std::all_of(state.last_words.begin(), state.last_words.end(), known)) {
    throw InputError(fmt::format("{}: its words do not fit each other, the file is damaged", path));
  }
  images_ = state.images;
  words_.restore(std::move(state.sums), std::move(state.totals));
  last_words_ = std::move(state.last_words);
  last_descriptors_ = state.last_descriptors;
  sample_.restore(std::move(state.sample), state.sample_stride, state.sample_offered);
  return state.position;
}

}  // namespace dxslam
