// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <functional>
#include <optional>

#include "slam/backend.h"
#include "slam/observer.h"
#include "slam/right_of_way.h"
#include "slam/snapshot_exchange.h"
#include "slam/system_options.h"
#include "tracking/tracker.h"

namespace dxslam {

/// Where the camera is, frame by frame (paper, Fig. 1): tracks it in the local map, looks for its
/// place in the whole map where that is not known, and begins a new map where it is not found.
/// Belongs to the tracking thread.
class TrackingSession {
 public:
  /// Looks for a frame in the whole map.
  using Relocalize = std::function<RelocalizationAnswer(const Frame&)>;

  /// `snapshots` and `right_of_way` must outlive this.
  TrackingSession(const Camera& camera, const DescriptorTraits& traits,
                  const SystemOptions& options, SnapshotExchange& snapshots,
                  RightOfWay& right_of_way, Relocalize find_in_map);

  /// There is a map, in which the first frames are somewhere.
  void go_on_with_map() { map_begun_ = true; }
  /// The frames from now on are of another recording: they may be anywhere in the map.
  void begin_recording();

  struct Result {
    TrackedFrame frame;
    std::optional<KeyframeRequest> request;  ///< for mapping; counts in `epoch`
    SnapshotExchange::Epoch epoch = 0;
    bool mapping = false;                 ///< or localization: what the request is for
    bool request_dropped = false;         ///< there was one
    std::optional<double> relocalize_ms;  ///< where its place was looked for in the whole map
    std::optional<PlaceFound> found;      ///< there
    std::optional<TrackingLost> lost;
  };
  /// The next frame; `mapping`, or localization in the map as it is.
  Result track_or_relocalize(const FramePtr& frame, bool mapping);

  /// As in FrameTracked, of the frame given last.
  std::optional<Matrix6d> covariance() const;
  /// The request of the last result is not served: what spoke for it counts on.
  void take_back_request() { tracker_.take_back_request(); }
  bool has_local_map() const { return tracker_.has_local_map(); }

 private:
  void follow_mapping();
  bool seeks_place(bool mapping);
  void track(const FramePtr& frame, Result& result);
  void relocalize(const FramePtr& frame, Result& result);
  void resume(const FramePtr& frame, const RelocalizationAnswer& answer, Result& result);
  void note_loss(Result& result);
  LossReason loss_reason(const TrackedFrame& frame) const;
  void begin_new_map_if_lost(const Frame& frame, bool mapping);
  bool can_begin_map(const Frame& frame) const;
  void go_on_elsewhere();

  const SystemOptions options_;
  SnapshotExchange& snapshots_;
  RightOfWay& right_of_way_;
  Relocalize find_in_map_;
  Tracker tracker_;
  bool seeking_ = false;    // where in the map the camera is, is not known
  bool map_begun_ = false;  // as far as this thread knows
  bool has_pose_ = false;   // the frame given last
  bool told_loss_ = false;  // and no frame since has a pose
  int lost_frames_ = 0;     // in a row
};

}  // namespace dxslam
