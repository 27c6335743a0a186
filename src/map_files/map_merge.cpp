// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "map_files/map_merge.h"

#include <algorithm>
#include <memory>
#include <vector>

namespace dxslam {
namespace {

// Adds the parts of another map, whose ids start again at 0.
void append(MapParts& parts, MapParts added) {
  std::vector<CameraId> camera_of;  // in the rig of both
  for (const Camera& camera : added.rig.cameras()) camera_of.push_back(parts.rig.add(camera));
  const auto keyframes = static_cast<KeyframeId>(parts.keyframes.size());
  const auto points = static_cast<PointId>(parts.points.size());
  std::uint32_t components = 0;
  for (const Keyframe& k : parts.keyframes) components = std::max(components, k.component + 1);
  for (Keyframe& k : added.keyframes) {
    const CameraId camera = camera_of[k.frame->camera];
    if (camera != k.frame->camera) {
      auto frame = std::make_shared<Frame>(*k.frame);
      frame->camera = camera;
      k.frame = std::move(frame);
    }
    k.id += keyframes;
    k.component += components;
    if (k.parent != kNoId) k.parent += keyframes;
    parts.keyframes.push_back(std::move(k));
  }
  for (MapPoint& p : added.points) {
    p.id += points;
    p.created_by += keyframes;
    for (PointObservation& o : p.observations) o.keyframe += keyframes;
    parts.points.push_back(std::move(p));
  }
  if (added.last_keyframe != kNoId) parts.last_keyframe = added.last_keyframe + keyframes;
}

}  // namespace

MapSnapshot merge_maps(const StoredMap& a, const std::string& name_a, const StoredMap& b,
                       const std::string& name_b) {
  const std::string where = name_b + " cannot be merged with " + name_a;
  require_same_features(b.header, a.header, where);
  MapSnapshot merged = take_snapshot(a.header, a.map, a.loops, a.thumbnails);
  MapSnapshot added = take_snapshot(b.header, b.map, b.loops, b.thumbnails);
  const auto keyframes = static_cast<KeyframeId>(merged.parts.keyframes.size());
  for (StoredLoopEdge loop : added.loops) {
    loop.a += keyframes;
    loop.b += keyframes;
    merged.loops.push_back(loop);
  }
  const std::size_t both = keyframes + added.parts.keyframes.size();
  if (!merged.thumbnails.empty() || !added.thumbnails.empty()) {
    merged.thumbnails.resize(keyframes);
    for (std::string& picture : added.thumbnails) merged.thumbnails.push_back(std::move(picture));
    merged.thumbnails.resize(both);
  }
  append(merged.parts, std::move(added.parts));
  return merged;
}

}  // namespace dxslam
