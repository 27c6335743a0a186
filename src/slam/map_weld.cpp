// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "slam/map_weld.h"

#include <algorithm>
#include <unordered_map>
#include <vector>

#include "loop_closing/loop_closer.h"
#include "slam/loop_search.h"
#include "slam/stored_system.h"
#include "slam/system_options.h"

namespace dxslam {

std::size_t weld_components(StoredMap& stored) {
  Map& map = stored.map;
  const MapHeader& header = stored.header;
  LoopSearch search(LoopOptions(), SystemOptions().loop_relaxation,
                    find_vocabulary("auto", header.extractor), header.extractor, header.traits);
  if (!search.usable()) return 0;
  LoopCloser closer(header.traits, LoopCloserOptions(), true);
  const std::vector<LoopEdge> known = loop_edges(stored.loops);
  closer.set_closed_loops(known);
  std::unordered_map<KeyframeId, std::uint32_t> origin;  // the component before any was joined
  const std::vector<KeyframeId> ids = map.keyframe_ids();
  for (const KeyframeId id : ids) origin[id] = map.keyframe(id).component;
  for (const KeyframeId id : ids) {
    const std::vector<LoopCandidate> found = search.search(map, id);
    if (found.empty() || !found.front().accepted()) continue;
    std::vector<KeyframeId> candidates;
    for (const LoopCandidate& candidate : found) {
      if (origin[candidate.id] != origin[id]) candidates.push_back(candidate.id);
    }
    if (candidates.empty()) continue;
    closer.consider(map, id, candidates);
    closer.wait(map);
  }
  stored.loops = stored_loops(map, closer.closed_loops());
  return closer.closed_loops().size() - known.size();
}

}  // namespace dxslam
