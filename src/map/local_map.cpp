// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "map/local_map.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace dxslam {
namespace {

bool contains(const std::vector<KeyframeId>& ids, KeyframeId id) {
  return std::find(ids.begin(), ids.end(), id) != ids.end();
}

void append_nearby(const Map& map, KeyframeId reference, const LocalMapOptions& options,
                   std::vector<KeyframeId>& ids) {
  const SE3& here = map.keyframe(reference).world_from_camera;
  const double max_angle = options.nearby_angle * std::numbers::pi / 180.0;
  std::vector<std::pair<double, KeyframeId>> nearby;
  for (const KeyframeId id : map.keyframe_ids()) {
    if (map.keyframe(id).component != map.keyframe(reference).component) continue;
    const SE3& there = map.keyframe(id).world_from_camera;
    const double distance =
        translation_distance(here, there) / std::max(1e-9, options.nearby_distance);
    const double angle = rotation_angle(here, there) / std::max(1e-9, max_angle);
    if (distance > 1.0 || angle > 1.0 || contains(ids, id)) continue;
    nearby.emplace_back(distance + angle, id);
  }
  std::sort(nearby.begin(), nearby.end());
  const std::size_t n = std::min(nearby.size(), static_cast<std::size_t>(options.nearby_keyframes));
  for (std::size_t i = 0; i < n; ++i) ids.push_back(nearby[i].second);
}

}  // namespace

int LocalMap::find(PointId id) const {
  const auto it = std::lower_bound(ids.begin(), ids.end(), id);
  return it != ids.end() && *it == id ? static_cast<int>(it - ids.begin()) : -1;
}

const SE3* LocalMap::find_pose(KeyframeId id) const {
  const auto it = std::lower_bound(keyframes.begin(), keyframes.end(), id);
  if (it == keyframes.end() || *it != id) return nullptr;
  return &keyframe_poses[static_cast<std::size_t>(it - keyframes.begin())];
}

std::vector<KeyframeId> local_keyframes(const Map& map, KeyframeId reference,
                                        const LocalMapOptions& options) {
  std::vector<KeyframeId> ids = {reference};
  for (const Covisible& c :
       map.best_covisibles(reference, static_cast<std::size_t>(options.keyframes), 1)) {
    ids.push_back(c.keyframe);
  }
  append_nearby(map, reference, options, ids);
  return ids;
}

std::vector<PointId> points_of(const Map& map, const std::vector<KeyframeId>& keyframes,
                               std::size_t most) {
  std::vector<PointId> ids;
  for (const KeyframeId k : keyframes) {
    for (const PointId p : map.keyframe(k).points) {
      if (p != kNoId) ids.push_back(p);
    }
    if (ids.size() / 4 > most) break;  // most are repeated a few times
  }
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  if (ids.size() > most) ids.erase(ids.begin(), ids.end() - static_cast<std::ptrdiff_t>(most));
  return ids;
}

LocalMapPtr make_local_map(const Map& map, KeyframeId reference, const LocalMapOptions& options) {
  auto local = std::make_shared<LocalMap>();
  const Keyframe& keyframe = map.keyframe(reference);
  local->reference = reference;
  local->component = keyframe.component;
  local->reference_frame = keyframe.frame;
  local->reference_camera = map.camera_of(reference);
  local->world_from_reference = keyframe.world_from_camera;
  local->reference_points = keyframe.points;
  local->keyframes = local_keyframes(map, reference, options);
  local->ids = points_of(map, local->keyframes, static_cast<std::size_t>(options.max_points));
  std::sort(local->keyframes.begin(), local->keyframes.end());
  for (const KeyframeId id : local->keyframes) {
    local->keyframe_poses.push_back(map.keyframe(id).world_from_camera);
  }
  local->descriptors.create(static_cast<int>(local->ids.size()), keyframe.frame->descriptors.cols,
                            keyframe.frame->descriptors.type());
  for (const PointId id : local->ids) {
    const MapPoint& p = map.point(id);
    map.descriptor_of(id).copyTo(local->descriptors.row(static_cast<int>(local->positions.size())));
    local->positions.push_back(p.position);
    local->normals.push_back(p.normal);
    local->distances.push_back(p.distance);
  }
  return local;
}

}  // namespace dxslam
