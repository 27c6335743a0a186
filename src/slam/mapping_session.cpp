// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "slam/mapping_session.h"

#include <algorithm>
#include <utility>

namespace dxslam {
namespace {

std::vector<KeyframePose> poses_of(const Map& map, const std::vector<KeyframeId>& ids) {
  std::vector<KeyframePose> poses;
  poses.reserve(ids.size());
  for (const KeyframeId id : ids) {
    const Keyframe& k = map.keyframe(id);
    poses.push_back({id, k.component, k.frame->stamp, k.world_from_camera});
  }
  return poses;
}

std::vector<PointPosition> positions_of(const Map& map, const std::vector<PointId>& ids) {
  std::vector<PointPosition> positions;
  positions.reserve(ids.size());
  for (const PointId id : ids) {
    const MapPoint& p = map.point(id);
    positions.push_back({id, map.keyframe(p.observations.front().keyframe).component, p.position});
  }
  return positions;
}

}  // namespace

void MappingSession::map_keyframe(const KeyframeRequest& request, Epoch epoch) {
  backend_.record_changes(events_.has_readers());
  const Stopwatch insert_watch;
  snapshots_.publish(epoch, backend_.insert(request));
  if (request.reference == kNoId) poses_.add_root(*request.frame, backend_.report().keyframe);
  times_.add("map_insert", insert_watch.ms());
  tell_changes(false);
  const Stopwatch refine_watch;
  snapshots_.publish(epoch, backend_.refine());
  times_.add("map_refine", refine_watch.ms());
  tell_changes(false);
  const Stopwatch loop_watch;
  LocalMapPtr moved = backend_.close_loops();
  const bool is_correction = moved != nullptr;
  if (moved) snapshots_.publish(epoch, std::move(moved));
  times_.add("loop_closing", loop_watch.ms());
  tell_loops();
  tell_changes(is_correction);
  count(backend_.report());
}

void MappingSession::follow(const KeyframeRequest& request, Epoch epoch) {
  snapshots_.publish(epoch, backend_.follow(request));
}

void MappingSession::tell_changes(bool is_correction) {
  const MapChanges changes = backend_.take_changes();
  const Map& map = backend_.map();
  MapChanged told;
  told.added_keyframes = poses_of(map, changes.added_keyframes);
  told.moved_keyframes = poses_of(map, changes.moved_keyframes);
  told.removed_keyframes = changes.removed_keyframes;
  told.added_points = positions_of(map, changes.added_points);
  told.moved_points = positions_of(map, changes.moved_points);
  told.removed_points = changes.removed_points;
  told.is_correction =
      is_correction && (!told.moved_keyframes.empty() || !told.moved_points.empty());
  events_.publish_change(std::move(told));
}

void MappingSession::tell_loops() {
  const LoopLog& log = backend_.loop_log();
  const std::size_t all = log.forgotten() + log.records().size();
  const std::size_t fresh = std::min(all - told_loops_, log.records().size());
  for (std::size_t i = log.records().size() - fresh; i < log.records().size(); ++i) {
    const LoopRecord& r = log.records()[i];
    events_.publish(
        LoopConsidered{r.query, r.candidate, r.accepted, r.verdict, r.effect, r.largest_move});
  }
  told_loops_ = all;
}

void MappingSession::count(const MappingReport& report) {
  ++totals_.keyframes;
  totals_.new_points += report.new_points;
  totals_.triangulated_points += report.triangulated_points;
  totals_.fused_points += report.fused_points;
  totals_.culled_points += report.culled_points;
  totals_.culled_keyframes += static_cast<int>(report.culled_keyframes.size());
  totals_.bundle_keyframes += report.bundle_keyframes;
  totals_.bundle_observations += report.bundle_observations;
  totals_.outlier_observations += report.outlier_observations;
}

MapChanged whole_map(const Map& map) {
  MapChanged whole;
  whole.added_keyframes = poses_of(map, map.keyframe_ids());
  whole.added_points = positions_of(map, map.point_ids());
  return whole;
}

}  // namespace dxslam
