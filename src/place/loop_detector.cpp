// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "place/loop_detector.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace dxslam {
namespace {

constexpr double kFarthest = 2.0;      // distance of two unit vectors
constexpr double kHighestScore = 2.0;  // of two equal vectors of words

void sort_by_confidence(std::vector<LoopCandidate>& candidates) {
  std::stable_sort(
      candidates.begin(), candidates.end(),
      [](const LoopCandidate& a, const LoopCandidate& b) { return a.confidence > b.confidence; });
}

}  // namespace

const char* to_string(LoopVerdict verdict) {
  switch (verdict) {
    case LoopVerdict::kAccepted:
      return "accepted";
    case LoopVerdict::kOutranked:
      return "another place is better";
    case LoopVerdict::kLowScore:
      return "too few common words";
    case LoopVerdict::kFarGlobal:
      return "global descriptor too far";
    case LoopVerdict::kFewInliers:
      return "too few matches agree";
    case LoopVerdict::kInconsistent:
      return "not confirmed by the queries before";
  }
  return "";
}

LoopDetector::LoopDetector(const LoopDetectorOptions& options)
    : options_(options), method_(parse_loop_method(options.method)) {
  validate_options("loops", options_);
}

void LoopDetector::add(std::uint32_t id, const BowVector& bow, const std::vector<float>& global) {
  places_.add(id, bow, global);
}

void LoopDetector::remove(std::uint32_t id) {
  places_.remove(id);
  if (last_place_ == id) last_place_.reset();
}

void LoopDetector::clear() {
  places_.clear();
  last_place_.reset();
  run_ = 0;
}

std::vector<LoopCandidate> LoopDetector::detect(const BowVector& bow,
                                                const std::vector<float>& global,
                                                const PlaceExclusion& excluded,
                                                const LoopVerifier& verify) {
  std::vector<LoopCandidate> candidates = rank(bow, global, excluded);
  if (method_.geometry) check_geometry(candidates, verify);
  const bool good = !candidates.empty() && judge(candidates.front()) == LoopVerdict::kAccepted;
  const bool confirmed =
      consistent(good ? std::optional<std::uint32_t>(candidates.front().id) : std::nullopt);
  if (candidates.empty()) return candidates;
  candidates.front().verdict =
      good && !confirmed ? LoopVerdict::kInconsistent : judge(candidates.front());
  return candidates;
}

std::vector<LoopCandidate> LoopDetector::rank(const BowVector& bow,
                                              const std::vector<float>& global,
                                              const PlaceExclusion& excluded) const {
  const auto wanted = static_cast<std::size_t>(
      method_.global && method_.words ? options_.candidates : options_.verified_candidates);
  std::vector<LoopCandidate> candidates;
  if (method_.words) {
    for (const BowMatch& match : places_.by_words(bow, wanted, excluded)) {
      LoopCandidate candidate;
      candidate.id = match.id;
      candidate.bow_score = match.score;
      candidate.confidence = match.score;
      if (places_.globals().contains(match.id) && !global.empty()) {
        candidate.global_distance = places_.globals().compare(match.id, global).distance();
      }
      candidates.push_back(candidate);
    }
  } else {
    for (const GlobalMatch& match : places_.globals().query(global, wanted, excluded)) {
      LoopCandidate candidate;
      candidate.id = match.id;
      candidate.global_distance = match.distance();
      candidates.push_back(candidate);
    }
  }
  if (!method_.global) return candidates;
  if (method_.agree) leave_out_unlike(candidates);
  candidates.erase(
      std::remove_if(candidates.begin(), candidates.end(),
                     [](const LoopCandidate& c) { return std::isnan(c.global_distance); }),
      candidates.end());
  for (LoopCandidate& c : candidates) c.confidence = kFarthest - c.global_distance;
  sort_by_confidence(candidates);
  if (!method_.agree) return candidates;
  for (LoopCandidate& c : candidates) {
    const bool vetoed = c.global_distance > options_.max_distance;
    c.confidence = vetoed ? c.bow_score - kHighestScore : c.bow_score;
  }
  return candidates;
}

// Candidates come by falling score.
void LoopDetector::leave_out_unlike(std::vector<LoopCandidate>& candidates) const {
  if (candidates.empty()) return;
  const double least = options_.min_relative_score * candidates.front().bow_score;
  candidates.erase(std::remove_if(candidates.begin(), candidates.end(),
                                  [&](const LoopCandidate& c) { return c.bow_score < least; }),
                   candidates.end());
}

void LoopDetector::check_geometry(std::vector<LoopCandidate>& candidates,
                                  const LoopVerifier& verify) const {
  require(static_cast<bool>(verify), "a method with geometry needs a verifier");
  candidates.resize(
      std::min(candidates.size(), static_cast<std::size_t>(options_.verified_candidates)));
  for (LoopCandidate& candidate : candidates) {
    candidate.inliers = verify(candidate.id);
    candidate.confidence = candidate.inliers;
  }
  sort_by_confidence(candidates);
}

LoopVerdict LoopDetector::judge(const LoopCandidate& candidate) const {
  if (method_.geometry) {
    const int least = method_.orb ? options_.min_inliers_orb : options_.min_inliers_hf;
    return candidate.inliers >= least ? LoopVerdict::kAccepted : LoopVerdict::kFewInliers;
  }
  if (method_.agree) {
    if (candidate.global_distance > options_.max_distance) return LoopVerdict::kFarGlobal;
    return candidate.bow_score >= options_.min_score_global ? LoopVerdict::kAccepted
                                                            : LoopVerdict::kLowScore;
  }
  if (method_.global) {
    const double most = method_.words ? options_.max_distance_paper : options_.max_distance_global;
    return candidate.global_distance <= most ? LoopVerdict::kAccepted : LoopVerdict::kFarGlobal;
  }
  const double least = method_.orb ? options_.min_score_orb : options_.min_score_hf;
  return candidate.bow_score >= least ? LoopVerdict::kAccepted : LoopVerdict::kLowScore;
}

bool LoopDetector::consistent(std::optional<std::uint32_t> place) {
  if (!place) {
    run_ = 0;
  } else {
    const bool near =
        last_place_ && std::max(*place, *last_place_) - std::min(*place, *last_place_) <=
                           static_cast<std::uint32_t>(options_.consistent_distance);
    run_ = near ? run_ + 1 : 1;
  }
  last_place_ = place;
  return run_ >= options_.consistent_queries;
}

}  // namespace dxslam
