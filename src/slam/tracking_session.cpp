// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "slam/tracking_session.h"

#include <utility>

namespace dxslam {
namespace {

TrackedFrame not_found(const Frame& frame) {
  TrackedFrame result;
  result.index = frame.index;
  result.stamp = frame.stamp;
  result.state = TrackingState::kLost;
  result.keypoints = static_cast<int>(frame.size());
  return result;
}

}  // namespace

TrackingSession::TrackingSession(const Camera& camera, const DescriptorTraits& traits,
                                 const SystemOptions& options, SnapshotExchange& snapshots,
                                 RightOfWay& right_of_way, Relocalize relocalize)
    : options_(options),
      snapshots_(snapshots),
      right_of_way_(right_of_way),
      relocalize_(std::move(relocalize)),
      tracker_(camera, traits, options.tracking) {}

TrackingSession::Result TrackingSession::track_or_relocalize(const FramePtr& frame, bool mapping) {
  if (LocalMapPtr local_map = snapshots_.take()) tracker_.set_local_map(std::move(local_map));
  Result result;
  result.mapping = mapping;
  result.frame = not_found(*frame);
  if (!seeks_place(mapping)) track(frame, result);
  if (result.frame.state == TrackingState::kLost) find_place(frame, result);
  if (result.frame.state == TrackingState::kLost) {
    begin_new_map_if_lost(*frame, mapping);
  } else {
    lost_frames_ = 0;
  }
  const bool was_tracking =
      std::exchange(tracking_, result.frame.state == TrackingState::kTracking);
  if (was_tracking && !tracking_) {
    result.lost =
        TrackingLost{frame->stamp, seeking_ ? LossReason::kPlaceUnknown : LossReason::kNoPose};
  }
  result.epoch = snapshots_.epoch();
  return result;
}

bool TrackingSession::seeks_place(bool mapping) {
  if (!tracker_.has_local_map()) {
    if (!mapping) seeking_ = true;  // it must not begin a map
    if (mapping && !map_begun_) seeking_ = false;
  }
  return seeking_;
}

void TrackingSession::track(const FramePtr& frame, Result& result) {
  const RightOfWay::Claim claim(right_of_way_);
  result.frame = tracker_.track(frame, result.request);
  map_begun_ = map_begun_ || result.request.has_value();
}

void TrackingSession::find_place(const FramePtr& frame, Result& result) {
  const RelocalizationAnswer answer = relocalize_(*frame);
  if (!answer.local_map) return;
  const RelocalizationReport& report = answer.report;
  const TrackedFrame tracked = tracker_.resume(frame, answer.local_map, report.world_from_camera,
                                               report.points, result.request);
  if (tracked.state != TrackingState::kTracking) return;
  snapshots_.begin_epoch();  // what is on its way is of where tracking was before
  seeking_ = false;
  result.frame = tracked;
  result.found = PlaceFound{frame->stamp, report.component, report.reference,
                            report.world_from_camera, report.confidence};
}

void TrackingSession::begin_new_map_if_lost(const Frame& frame, bool mapping) {
  if (can_begin_map(frame)) ++lost_frames_;
  if (lost_frames_ < options_.new_map_after || !mapping) return;
  go_on_elsewhere();
  seeking_ = false;
}

// A covered lens or a bare wall is no reason to give up a map.
bool TrackingSession::can_begin_map(const Frame& frame) const {
  return frame.depth_count() >= options_.tracking.min_start_points;
}

void TrackingSession::begin_recording() {
  seeking_ = map_begun_;
  tracking_ = false;  // nothing is lost
  go_on_elsewhere();
}

void TrackingSession::go_on_elsewhere() {
  tracker_.restart();
  snapshots_.begin_epoch();
  lost_frames_ = 0;
}

}  // namespace dxslam
