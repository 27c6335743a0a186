// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstddef>
#include <map>
#include <string>

#include "slam/mapping_totals.h"
#include "slam/observer.h"
#include "slam/stage_times.h"

namespace dxslam {

/// How large the map was when a recording ended.
struct MapSize {
  std::size_t keyframes = 0;
  std::size_t points = 0;
};

/// How a run went, added up from its messages. Its memory does not grow with them.
///
///   RunStatistics statistics;
///   EventReader reader(system.subscribe(Subscription::kUnbounded, RunStatistics::kinds()),
///                      [&](const Message& message) { statistics.add(message.event); });
///
/// One thread at a time, but any may ask for stages() meanwhile.
class RunStatistics {
 public:
  /// The events that count.
  static constexpr EventKinds kinds() {
    return EventKinds::of<FrameTracked, KeyframeMapped, RecordingEnded, RunFinished>();
  }

  void add(const Event& event);

  /// Times of the stages: per frame `extract`, `track` and both together, `frame`; where the place
  /// was looked for `relocalize`; per keyframe `map_insert`, `map_refine` and `loop_closing`; once
  /// `full_bundle`.
  std::map<std::string, StageSummary> stages() const { return times_.summaries(); }
  const MappingTotals& mapping() const { return mapping_; }
  /// Of the recordings that have ended, by their number.
  const std::map<int, MapSize>& map_sizes() const { return map_sizes_; }

 private:
  void add_frame(const FrameTracked& tracked);
  void add_keyframe(const KeyframeMapped& mapped);

  StageTimes times_;
  MappingTotals mapping_;
  std::map<int, MapSize> map_sizes_;
};

}  // namespace dxslam
