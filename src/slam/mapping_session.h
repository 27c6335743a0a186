// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstddef>
#include <functional>

#include "slam/backend.h"
#include "slam/event_stream.h"
#include "slam/snapshot_exchange.h"
#include "slam/tracked_poses.h"

namespace dxslam {

/// What mapping does with the keyframes that tracking asks for: works them into the map step by
/// step, hands each new state back, and tells of it. Belongs to the mapping thread.
class MappingSession {
 public:
  using Epoch = SnapshotExchange::Epoch;

  /// All must outlive this.
  MappingSession(Backend& backend, SnapshotExchange& snapshots, EventStream& events,
                 TrackedPoses& poses)
      : backend_(backend), snapshots_(snapshots), events_(events), poses_(poses) {}

  /// Local mapping and loop closing for a new keyframe.
  void map_keyframe(const KeyframeRequest& request, Epoch epoch);
  /// Localization only: the local map around the frame.
  void follow(const KeyframeRequest& request, Epoch epoch);
  /// Calls `change`, which moves what is in the map, and tells of it.
  void correct(const std::function<void()>& change);
  /// The whole map, as if it had just been added. What changes from now on is told.
  MapChanged begin_telling();

 private:
  void tell_changes(bool is_correction);
  void tell_loops();
  void tell_loop(const LoopRecord& record);

  Backend& backend_;
  SnapshotExchange& snapshots_;
  EventStream& events_;
  TrackedPoses& poses_;
  std::size_t told_loops_ = 0;  // of all that the loop log ever had
};

/// The whole map as if it had just been added.
MapChanged whole_map(const Map& map);

}  // namespace dxslam
