// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

// For tests only: small maps, and whether the relations of a map agree.

#include <gtest/gtest.h>

#include <map>
#include <utility>
#include <vector>

#include "map/map.h"
#include "map/point_scene.h"

namespace dxslam {

/// A map of `n` keyframes along the path in which every scene point is one map point.
struct BuiltMap {
  explicit BuiltMap(int n) {
    map.add_camera(scene.camera());
    std::map<int, PointId> point_of;
    for (int k = 0; k < n; ++k) {
      std::vector<int> source;
      const SE3 pose = PointScene::pose(0.1 * k);
      const FramePtr frame = scene.frame(k, pose, 0.0, 1.0, &source);
      const KeyframeId id =
          map.add_keyframe(frame, pose, k == 0 ? kNoId : static_cast<KeyframeId>(k - 1));
      bind_to_points(id, source, scene, SE3(), point_of, map);
    }
  }
  PointScene scene{400};
  Map map;
};

/// Both directions of every relation agree, and covisibility is what a slow count says.
inline void expect_consistent(const Map& map) {
  std::map<std::pair<KeyframeId, KeyframeId>, int> shared;
  std::size_t bound = 0;
  for (const PointId id : map.point_ids()) {
    const MapPoint& p = map.point(id);
    ASSERT_FALSE(p.observations.empty());
    ASSERT_LT(p.descriptor, p.observations.size());
    for (const PointObservation& a : p.observations) {
      ++bound;
      ASSERT_EQ(map.keyframe(a.keyframe).points[a.keypoint], id);
      for (const PointObservation& b : p.observations) {
        if (a.keyframe != b.keyframe) ++shared[{a.keyframe, b.keyframe}];
      }
    }
  }
  std::size_t taken = 0;
  std::size_t edges = 0;
  for (const KeyframeId id : map.keyframe_ids()) {
    const Keyframe& k = map.keyframe(id);
    for (const PointId p : k.points) taken += p != kNoId ? 1 : 0;
    for (const Covisible& c : k.covisibles) {
      ASSERT_EQ((shared[{id, c.keyframe}]), c.shared);
      ++edges;
    }
    ASSERT_TRUE(k.parent == kNoId || map.has_keyframe(k.parent));
  }
  ASSERT_EQ(taken, bound);
  ASSERT_EQ(edges, shared.size());
}

}  // namespace dxslam
