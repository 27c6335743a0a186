// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "slam/mapping_session.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "slam/stage_times.h"

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
  backend_.record_changes(events_.has_readers_of<MapChanged>());
  KeyframeMapped mapped;
  mapped.frame = request.frame->index;
  const Stopwatch insert_watch;
  snapshots_.publish(epoch, backend_.insert(request));
  if (request.reference == kNoId) poses_.add_root(*request.frame, backend_.report().keyframe);
  mapped.insert_ms = insert_watch.ms();
  tell_changes(false);
  const Stopwatch refine_watch;
  snapshots_.publish(epoch, backend_.refine());
  mapped.refine_ms = refine_watch.ms();
  tell_changes(false);
  const Stopwatch loop_watch;
  LocalMapPtr moved = backend_.close_loops();
  const bool is_correction = moved != nullptr;
  if (moved) snapshots_.publish(epoch, std::move(moved));
  mapped.loop_closing_ms = loop_watch.ms();
  tell_loops();
  tell_changes(is_correction);
  mapped.report = backend_.report();
  events_.publish(std::move(mapped));
}

void MappingSession::follow(const KeyframeRequest& request, Epoch epoch) {
  snapshots_.publish(epoch, backend_.follow(request));
}

void MappingSession::correct(const std::function<void()>& change) {
  backend_.record_changes(true);  // it may change nothing, which is not told
  change();
  tell_changes(true);
}

MapChanged MappingSession::begin_telling() {
  backend_.record_changes(true);
  return whole_map(backend_.map());
}

void MappingSession::tell_changes(bool is_correction) {
  const MapChanges changes = backend_.take_changes();
  const Map& map = backend_.map();
  if (map.records_changes() && changes.empty()) return;
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
    tell_loop(log.records()[i]);
  }
  told_loops_ = all;
}

void MappingSession::tell_loop(const LoopRecord& r) {
  LoopFound found{r.query, r.candidate, r.bow_score, std::nullopt};
  if (std::isfinite(r.global_distance)) found.global_distance = r.global_distance;
  events_.publish(found);
  if (!r.accepted) {
    events_.publish(LoopRefused{r.query, r.candidate, r.verdict});
  } else if (r.joined) {
    events_.publish(MapsJoined{r.query, r.candidate, r.joined->kept, r.joined->gone});
  } else {
    events_.publish(LoopClosed{r.query, r.candidate, r.largest_move});
  }
}

MapChanged whole_map(const Map& map) {
  MapChanged whole;
  whole.added_keyframes = poses_of(map, map.keyframe_ids());
  whole.added_points = positions_of(map, map.point_ids());
  return whole;
}

}  // namespace dxslam
