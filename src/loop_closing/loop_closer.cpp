// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "loop_closing/loop_closer.h"

#include <algorithm>
#include <set>
#include <utility>

#include "core/options.h"

namespace dxslam {

const char* LoopAttempt::verdict() const {
  return verification.accepted ? describe(plan.refusal) : describe(verification.rejection);
}

LoopCloser::LoopCloser(const DescriptorTraits& traits, const LoopCloserOptions& options,
                       bool repeatable, Pause pause)
    : traits_(traits),
      options_((validate_options("loop_closing", options), options)),
      bundle_(options.bundle, repeatable, std::move(pause)) {}

LoopReport LoopCloser::consider(Map& map, KeyframeId query,
                                const std::vector<KeyframeId>& candidates) {
  LoopReport report;
  report.query = query;
  if (last_closed_ && query >= *last_closed_ &&
      query - *last_closed_ < static_cast<KeyframeId>(options_.pause_keyframes)) {
    report.paused = true;
    return report;
  }
  for (const KeyframeId candidate : candidates) {
    if (report.attempts.size() >= static_cast<std::size_t>(options_.max_candidates)) break;
    LoopAttempt attempt;
    attempt.verification = verify_loop(map, query, candidate, traits_, options_.verification);
    if (attempt.verification.accepted) {
      attempt.plan = plan_loop_correction(map, attempt.verification, closed_, options_.correction);
    }
    report.attempts.push_back(std::move(attempt));
    if (report.attempts.back().plan.effect == LoopEffect::kNone) continue;
    carry_out(report.attempts.back(), map, report);
    break;
  }
  return report;
}

void LoopCloser::carry_out(const LoopAttempt& attempt, Map& map, LoopReport& report) {
  report.effect = attempt.plan.effect;
  report.match = attempt.verification.candidate;
  // An adjustment under way knows nothing of the correction and would undo it.
  const bool moves = report.effect != LoopEffect::kWeld;
  if (moves) bundle_.cancel();
  report.change = apply_loop_plan(attempt.plan, attempt.verification, traits_, options_.correction,
                                  map, closed_);
  forget_doubles(map);
  last_closed_ = report.query;
  if (!moves || !options_.full_bundle) return;
  bundle_.start(map, map.keyframe(report.query).component);
  report.bundle_started = true;
}

// The essential graph has one edge for each pair of living keyframes: more of them, which gather
// where a place is seen again and again, tell it nothing.
void LoopCloser::forget_doubles(const Map& map) {
  std::set<std::pair<KeyframeId, KeyframeId>> known;
  std::vector<LoopEdge> kept;
  for (const LoopEdge& loop : closed_) {
    const LoopEdge living{map.anchor_of(loop.a).keyframe, map.anchor_of(loop.b).keyframe};
    if (living.a == living.b) continue;
    if (known.insert(std::minmax(living.a, living.b)).second) kept.push_back(living);
  }
  closed_ = std::move(kept);
}

}  // namespace dxslam
