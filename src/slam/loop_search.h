// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "core/features.h"
#include "map/map.h"
#include "place/loop_detector.h"
#include "vocabulary/vocabulary.h"

namespace dxslam {

/// Which keyframes may show the same place as a new one (paper III.E): the words and the global
/// descriptors of a map's keyframes, kept beside the map. Belongs to the thread that owns the map.
class LoopSearch {
 public:
  /// `relaxation` loosens the thresholds of `options`. Takes what is there: words with a vocabulary
  /// that fits the descriptors, global descriptors where the extractor has them; the method of
  /// `options` is narrowed accordingly. Throws InputError if the vocabulary is given but cannot be
  /// read or is not of the extractor `features`, whose descriptors are of `traits`.
  LoopSearch(const LoopOptions& options, double relaxation, const std::string& vocabulary,
             const std::string& features, const DescriptorTraits& traits);

  /// False where there is neither: no loop can be found.
  bool usable() const { return detector_.has_value(); }
  /// The method in use, e.g. "hf-bow-global"; "none" where there is none.
  const std::string& method() const { return method_; }

  /// Keyframes to be added before the next search, a few at a time.
  void add_later(const std::vector<KeyframeId>& keyframes);
  void remove(KeyframeId keyframe);
  /// Candidates for `keyframe`, best first, then adds it. Those that the map ties to it already
  /// are left out.
  std::vector<LoopCandidate> search(const Map& map, KeyframeId keyframe);

 private:
  void add(const Map& map, KeyframeId keyframe);
  BowVector words_of(const Frame& frame) const;

  std::optional<Vocabulary> vocabulary_;
  std::optional<LoopDetector> detector_;
  std::string method_ = "none";
  std::deque<KeyframeId> waiting_;
};

/// A vocabulary as configured: "auto" is the one shipped for `features`, "" where there is none,
/// "none" is "", anything else is a file.
std::string find_vocabulary(const std::string& configured, const std::string& features);

}  // namespace dxslam
