// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "slam/loop_search.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <unordered_set>

#include "core/error.h"
#include "features/data_directory.h"

namespace dxslam {
namespace {

constexpr int kAddedAtOnce = 10;    // of a loaded map, so that no search takes long
constexpr KeyframeId kRecent = 10;  // keyframes just made are tied by tracking already
constexpr int kMinShared = 5;       // points that tie two keyframes

std::string narrowed_method(const std::string& wanted, bool words, const DescriptorTraits& traits) {
  if (words && traits.binary) return "orb-bow";
  const bool global = traits.global_dimension > 0;
  if (words) return global ? wanted : "hf-bow";
  return global ? "global-only" : "none";
}

LoopOptions loosened(LoopOptions options, double by) {
  for (double* least : {&options.min_score_orb, &options.min_score_hf, &options.min_score_global}) {
    *least /= by;
  }
  for (double* most :
       {&options.max_distance, &options.max_distance_paper, &options.max_distance_global}) {
    *most = std::min(2.0, *most * by);
  }
  return options;
}

// The keyframe itself, its covisible ones and those that share points with these.
std::unordered_set<KeyframeId> tied_to(const Map& map, KeyframeId keyframe) {
  std::unordered_set<KeyframeId> tied = {keyframe};
  for (const Covisible& near : map.keyframe(keyframe).covisibles) {
    if (near.shared < kMinShared) continue;
    tied.insert(near.keyframe);
    for (const Covisible& far : map.keyframe(near.keyframe).covisibles) {
      if (far.shared >= kMinShared) tied.insert(far.keyframe);
    }
  }
  return tied;
}

}  // namespace

LoopSearch::LoopSearch(const LoopOptions& options, double relaxation, const std::string& vocabulary,
                       const std::string& features, const DescriptorTraits& traits) {
  if (!vocabulary.empty()) {
    vocabulary_ = Vocabulary::load(vocabulary);
    require_words_of(*vocabulary_, vocabulary, features, traits.binary, traits.dimension);
  }
  method_ = narrowed_method(options.method, vocabulary_.has_value(), traits);
  if (method_ == "none") return;
  LoopOptions narrowed = loosened(options, relaxation);
  narrowed.method = method_;
  detector_.emplace(narrowed);
}

void LoopSearch::add_later(const std::vector<KeyframeId>& keyframes) {
  waiting_.insert(waiting_.end(), keyframes.begin(), keyframes.end());
}

void LoopSearch::remove(KeyframeId keyframe) {
  if (detector_) detector_->remove(keyframe);
}

BowVector LoopSearch::words_of(const Frame& frame) const {
  return vocabulary_ ? vocabulary_->transform(frame.descriptors) : BowVector{};
}

void LoopSearch::add(const Map& map, KeyframeId keyframe) {
  const Frame& frame = *map.keyframe(keyframe).frame;
  if (!detector_->places().contains(keyframe)) {
    detector_->add(keyframe, words_of(frame), frame.global);
  }
}

std::vector<LoopCandidate> LoopSearch::search(const Map& map, KeyframeId keyframe) {
  if (!detector_) return {};
  for (int i = 0; i < kAddedAtOnce && !waiting_.empty(); ++i) {
    if (map.has_keyframe(waiting_.front())) add(map, waiting_.front());
    waiting_.pop_front();
  }
  const Frame& frame = *map.keyframe(keyframe).frame;
  const BowVector words = words_of(frame);
  const auto tied = tied_to(map, keyframe);
  const std::uint32_t component = map.keyframe(keyframe).component;
  const auto excluded = [&](std::uint32_t id) {
    if (!map.has_keyframe(id) || tied.count(id) != 0) return true;
    return map.keyframe(id).component == component && id < keyframe && keyframe - id <= kRecent;
  };
  std::vector<LoopCandidate> candidates = detector_->detect(words, frame.global, excluded);
  detector_->add(keyframe, words, frame.global);
  return candidates;
}

std::string find_vocabulary(const std::string& configured, const std::string& features) {
  if (configured == "none") return "";
  if (configured != "auto") return configured;
  const std::filesystem::path path =
      std::filesystem::path(data_directory()) / "models" / "vocabulary" / (features + ".fbow");
  return std::filesystem::exists(path) ? path.string() : "";
}

}  // namespace dxslam
