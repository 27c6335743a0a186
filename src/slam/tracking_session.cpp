// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "slam/tracking_session.h"

#include <utility>

#include "slam/stage_times.h"

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

bool is_lost(const TrackedFrame& frame) { return frame.state == TrackingState::kLost; }

}  // namespace

TrackingSession::TrackingSession(const Camera& camera, const DescriptorTraits& traits,
                                 const SystemOptions& options, SnapshotExchange& snapshots,
                                 RightOfWay& right_of_way, Relocalize find_in_map)
    : options_(options),
      snapshots_(snapshots),
      right_of_way_(right_of_way),
      find_in_map_(std::move(find_in_map)),
      tracker_(camera, traits, options.tracking) {}

TrackingSession::Result TrackingSession::track_or_relocalize(const FramePtr& frame, bool mapping) {
  follow_mapping();
  Result result;
  result.mapping = mapping;
  result.frame = not_found(*frame);
  if (!seeks_place(mapping)) track(frame, result);
  if (is_lost(result.frame)) relocalize(frame, result);
  note_loss(result);
  if (is_lost(result.frame)) {
    begin_new_map_if_lost(*frame, mapping);
  } else {
    lost_frames_ = 0;
  }
  result.frame.is_keyframe = result.frame.is_keyframe && mapping;
  result.epoch = snapshots_.epoch();
  return result;
}

void TrackingSession::follow_mapping() {
  if (LocalMapPtr local_map = snapshots_.take()) tracker_.set_local_map(std::move(local_map));
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

void TrackingSession::relocalize(const FramePtr& frame, Result& result) {
  const Stopwatch watch;
  const RelocalizationAnswer answer = find_in_map_(*frame);
  result.relocalize_ms = watch.ms();
  if (answer.local_map) resume(frame, answer, result);
}

void TrackingSession::resume(const FramePtr& frame, const RelocalizationAnswer& answer,
                             Result& result) {
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

void TrackingSession::note_loss(Result& result) {
  has_pose_ = result.frame.state == TrackingState::kTracking;
  if (!has_pose_ && !told_loss_) {
    const int matches = seeking_ ? 0 : tracker_.most_matches();
    result.lost = TrackingLost{result.frame.stamp, loss_reason(result.frame),
                               result.frame.keypoints, matches};
  }
  told_loss_ = !has_pose_;
}

LossReason TrackingSession::loss_reason(const TrackedFrame& frame) const {
  if (!seeking_) return tracker_.loss_reason();
  const bool blind = frame.keypoints < options_.tracking.min_inliers;
  return blind ? LossReason::kFewKeypoints : LossReason::kPlaceUnknown;
}

std::optional<Matrix6d> TrackingSession::covariance() const {
  return has_pose_ ? tracker_.covariance() : std::nullopt;
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
  told_loss_ = false;
  go_on_elsewhere();
}

void TrackingSession::go_on_elsewhere() {
  tracker_.restart();
  snapshots_.begin_epoch();
  lost_frames_ = 0;
}

}  // namespace dxslam
