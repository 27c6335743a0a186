// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "apps/map_io.h"

#include <fmt/format.h>

#include <chrono>
#include <exception>

#include "apps/console.h"
#include "core/error.h"

namespace dxslam::apps {

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

bool AutoSaver::is_ready() {
  return !under_way_.valid() ||
         under_way_.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

void AutoSaver::save(const Map& map, const std::vector<LoopEdge>& loops,
                     const std::vector<std::string>& thumbnails) {
  finish();
  attempt([&] {
    under_way_ = std::async(
        std::launch::async,
        [path = path_, snapshot = take_snapshot(header_, map, stored_loops(map, loops),
                                                thumbnails)] { save_map(path, snapshot); });
  });
}

void AutoSaver::finish() {
  if (under_way_.valid()) attempt([this] { under_way_.get(); });
}

void AutoSaver::attempt(const std::function<void()>& step) {
  try {
    step();
  } catch (const std::exception& e) {
    if (!warned_) warn("autosave: {}; the run goes on and tries again", e.what());
    warned_ = true;
  }
}

}  // namespace dxslam::apps
