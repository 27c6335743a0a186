// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "loop_closing/keyframe_group.h"

#include <unordered_set>

namespace dxslam {

KeyframeGroup gather_group(const Map& map, KeyframeId keyframe, std::size_t keyframes,
                           int min_shared, std::size_t max_points) {
  KeyframeGroup group;
  group.keyframes.push_back(keyframe);
  for (const Covisible& c : map.best_covisibles(keyframe, keyframes - 1, min_shared)) {
    group.keyframes.push_back(c.keyframe);
  }
  std::unordered_set<PointId> known;
  for (const KeyframeId id : group.keyframes) {
    for (const PointId p : map.keyframe(id).points) {
      if (group.points.size() >= max_points) return group;
      if (p != kNoId && known.insert(p).second) group.points.push_back(p);
    }
  }
  return group;
}

}  // namespace dxslam
