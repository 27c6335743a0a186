// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstdint>

#include "slam/backend.h"
#include "slam/event_stream.h"
#include "slam/mapping_totals.h"
#include "slam/snapshot_exchange.h"
#include "slam/stage_times.h"
#include "slam/tracked_poses.h"

namespace dxslam {

/// What mapping does with the keyframes that tracking asks for: works them into the map step by
/// step, hands each new state back, and tells of it. Belongs to the mapping thread.
class MappingSession {
 public:
  using Epoch = SnapshotExchange::Epoch;

  /// All must outlive this.
  MappingSession(Backend& backend, SnapshotExchange& snapshots, EventStream& events,
                 StageTimes& times, TrackedPoses& poses)
      : backend_(backend), snapshots_(snapshots), events_(events), times_(times), poses_(poses) {}

  /// Local mapping and loop closing for a new keyframe.
  void map_keyframe(const KeyframeRequest& request, Epoch epoch);
  /// Localization only: the local map around the frame.
  void follow(const KeyframeRequest& request, Epoch epoch);
  /// Tells what has changed in the map since this was called last.
  void tell_changes(bool is_correction);

  const MappingTotals& totals() const { return totals_; }

 private:
  void tell_loops();
  void count(const MappingReport& report);

  Backend& backend_;
  SnapshotExchange& snapshots_;
  EventStream& events_;
  StageTimes& times_;
  TrackedPoses& poses_;
  MappingTotals totals_;
  std::size_t told_loops_ = 0;  // of all that the loop log ever had
};

/// The whole map as if it had just been added.
MapChanged whole_map(const Map& map);

}  // namespace dxslam
