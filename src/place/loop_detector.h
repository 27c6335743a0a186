// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "place/loop_options.h"
#include "place/place_database.h"

namespace dxslam {

enum class LoopVerdict {
  kAccepted,
  kOutranked,     ///< another candidate of the same query is better
  kLowScore,      ///< too few words in common
  kFarGlobal,     ///< global descriptors too different
  kFewInliers,    ///< no geometry that enough matches agree on
  kInconsistent,  ///< the queries before did not lead to the same part of the map
};

/// A few words for people, e.g. "global descriptor too far".
const char* to_string(LoopVerdict verdict);

struct LoopCandidate {
  std::uint32_t id = 0;
  double bow_score = 0.0;  ///< 0 to 2; 0 where the method looks at no words
  /// L2, 0 to 2; NaN where there are no global descriptors.
  double global_distance = std::numeric_limits<double>::quiet_NaN();
  int inliers = -1;         ///< of the geometric check; -1 where it was not made
  double confidence = 0.0;  ///< what the method decides by, larger is surer
  LoopVerdict verdict = LoopVerdict::kOutranked;

  bool accepted() const { return verdict == LoopVerdict::kAccepted; }
};

/// Inliers of the geometric check between the query and a place.
using LoopVerifier = std::function<int(std::uint32_t id)>;

/// Finds returns to known places from two levels of features (paper III.E), over plain ids: the
/// caller says which places must not be found (covisible or recent ones).
/// - orb-bow, hf-bow: the most similar place by words, if similar enough;
/// - hf-bow-global-paper: of the `candidates` most similar places by words the one with the nearest
///   global descriptor, if near enough (the paper to the letter);
/// - hf-bow-global: the same place, if it is also similar enough by words: the nearest global
///   descriptor picks, and both levels must agree. Its distance is only a veto, so that the
///   threshold that decides carries over between scenes (docs/loops.md);
/// - global-only: the place with the nearest global descriptor, if near enough;
/// - ...+geometry: of the first `verified_candidates` of these the one that has most inliers, if
///   enough; scores and distances then only rank.
/// Ids should rise in time if consistency is asked for. One thread at a time.
class LoopDetector {
 public:
  /// Throws InputError for options out of range or an unknown method.
  explicit LoopDetector(const LoopDetectorOptions& options = {});

  const LoopDetectorOptions& options() const { return options_; }
  const LoopMethod& method() const { return method_; }
  const PlaceDatabase& places() const { return places_; }

  /// As PlaceDatabase::add and remove.
  void add(std::uint32_t id, const BowVector& bow, const std::vector<float>& global);
  void remove(std::uint32_t id);
  void clear();

  /// All candidates that were looked at, best first; only the first may be accepted. Empty where
  /// nothing is similar at all. A method with global descriptors passes over places without one.
  /// `verify` is needed for methods with geometry: throws ContractError without.
  std::vector<LoopCandidate> detect(const BowVector& bow, const std::vector<float>& global,
                                    const PlaceExclusion& excluded = {},
                                    const LoopVerifier& verify = {});

 private:
  std::vector<LoopCandidate> rank(const BowVector& bow, const std::vector<float>& global,
                                  const PlaceExclusion& excluded) const;
  void leave_out_unlike(std::vector<LoopCandidate>& candidates) const;
  void check_geometry(std::vector<LoopCandidate>& candidates, const LoopVerifier& verify) const;
  LoopVerdict judge(const LoopCandidate& candidate) const;
  bool consistent(std::optional<std::uint32_t> place);

  LoopDetectorOptions options_;
  LoopMethod method_;
  PlaceDatabase places_;
  std::optional<std::uint32_t> last_place_;  // of the query before, if it was good enough
  int run_ = 0;                              // queries in a row that led to nearby places
};

}  // namespace dxslam
