// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <optional>
#include <vector>

#include "core/features.h"
#include "loop_closing/background_bundle.h"
#include "loop_closing/loop_closing_options.h"
#include "loop_closing/loop_correction.h"
#include "loop_closing/loop_verification.h"
#include "map/map.h"

namespace dxslam {

/// One candidate, from verification to its effect on the map.
struct LoopAttempt {
  LoopVerification verification;
  LoopPlan plan;  ///< as at the start if the verification rejected the candidate
  /// "accepted", or the one reason why not.
  const char* verdict() const;
};

/// What came of the candidates of one keyframe.
struct LoopReport {
  KeyframeId query = kNoId;
  bool paused = false;  ///< soon after another loop: nothing was looked at
  LoopEffect effect = LoopEffect::kNone;
  KeyframeId match = kNoId;           ///< the candidate that was accepted
  LoopChange change;                  ///< what it did
  std::vector<LoopAttempt> attempts;  ///< in the order given, up to the accepted one
  bool bundle_started = false;
};

/// Closes loops in a map: verifies candidates, corrects the map, and adjusts it as a whole in the
/// background (paper III.E; the step between detection and the map). Belongs to the thread that
/// owns the map, and touches the map only within its calls.
///
///   LoopReport report = closer.consider(map, keyframe, candidates);  // for each new keyframe
///   if (auto merge = closer.poll(map)) ...                           // now and then
///
/// Whenever either changed poses (report.effect is kBend or kJoin; a merge), the snapshots that
/// others hold are out of date.
class LoopCloser {
 public:
  /// `repeatable`: the bundle is adjusted within consider(), and merged by the next poll().
  /// `pause` is for the adjustment. Throws InputError for options out of range.
  LoopCloser(const DescriptorTraits& traits, const LoopCloserOptions& options, bool repeatable,
             Pause pause = {});

  /// Tries the candidates, best first, until one is accepted. The map is unchanged if none is.
  /// `query` must be in the map; candidates may have been removed meanwhile, and may be of other
  /// components, which are then joined.
  LoopReport consider(Map& map, KeyframeId query, const std::vector<KeyframeId>& candidates);

  /// Merges the adjusted map if it is ready. Never waits.
  std::optional<BundleMerge> poll(Map& map) { return bundle_.poll(map); }
  /// Waits for the adjustment under way, if any, and merges it.
  std::optional<BundleMerge> wait(Map& map) { return bundle_.wait(map); }
  /// Gives up the adjustment under way, if any.
  void cancel() { bundle_.cancel(); }
  bool bundle_pending() const { return bundle_.pending(); }

  /// The loops closed so far, one for each pair of keyframes. They belong to the map: save them
  /// with it and hand them back.
  const std::vector<LoopEdge>& closed_loops() const { return closed_; }
  void set_closed_loops(std::vector<LoopEdge> closed) { closed_ = std::move(closed); }

 private:
  void forget_doubles(const Map& map);
  void carry_out(const LoopAttempt& attempt, Map& map, LoopReport& report);

  DescriptorTraits traits_;
  LoopCloserOptions options_;
  std::vector<LoopEdge> closed_;
  std::optional<KeyframeId> last_closed_;
  BackgroundBundle bundle_;
};

}  // namespace dxslam
