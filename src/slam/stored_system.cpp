// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "slam/stored_system.h"

#include <fmt/format.h>

#include <utility>

#include "core/error.h"

namespace dxslam {

std::vector<StoredLoopEdge> stored_loops(const Map& map, const std::vector<LoopEdge>& loops) {
  std::vector<StoredLoopEdge> stored;
  for (const LoopEdge& edge : loops) {
    const Map::Anchor a = map.anchor_of(edge.a);
    const Map::Anchor b = map.anchor_of(edge.b);
    stored.push_back({a.keyframe, b.keyframe,
                      map.keyframe(a.keyframe).world_from_camera.inverse() *
                          map.keyframe(b.keyframe).world_from_camera});
  }
  return stored;
}

std::vector<LoopEdge> loop_edges(const std::vector<StoredLoopEdge>& stored) {
  std::vector<LoopEdge> loops;
  for (const StoredLoopEdge& edge : stored) loops.push_back({edge.a, edge.b});
  return loops;
}

MapHeader map_header(const FeatureExtractor& extractor) {
  return {extractor.name(), extractor.model_hash(), extractor.traits()};
}

std::vector<std::string> hand_over(StoredMap stored, System& system, const std::string& path,
                                   const MapHeader& current) {
  require_same_features(stored.header, current, path);
  if (stored.map.keyframe_count() == 0) {
    throw InputError(fmt::format("{}: the map has no keyframe, expected some to go on with", path));
  }
  stored.thumbnails.resize(stored.map.keyframe_ids().back() + std::size_t{1});
  system.load_map(std::move(stored.map), loop_edges(stored.loops));
  return std::move(stored.thumbnails);
}

void save_system_map(const std::string& path, const MapHeader& header, const Map& map,
                     const std::vector<LoopEdge>& loops,
                     const std::vector<std::string>& thumbnails) {
  require(map.keyframe_count() > 0, "an empty map must not be saved");
  save_map(path, take_snapshot(header, map, stored_loops(map, loops), thumbnails));
}

}  // namespace dxslam
