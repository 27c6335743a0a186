// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cmath>
#include <map>
#include <memory>
#include <vector>

#include "map/map.h"
#include "map/point_scene.h"

namespace dxslam {

/// A global descriptor that turns with `place`: the nearer two places, the more alike.
inline std::vector<float> global_at(double place) {
  return {static_cast<float>(std::cos(place)), static_cast<float>(std::sin(place)), 0.0F};
}

inline FramePtr with_global(const FramePtr& frame, std::vector<float> global) {
  auto copy = std::make_shared<Frame>(*frame);
  copy->global = std::move(global);
  return copy;
}

/// Adds `count` keyframes along the path of the scene, with its points as map points, as a new
/// component whose world is moved by `world_from_scene`. Their places start at `place`.
inline std::vector<KeyframeId> add_scene(PointScene& scene, int count, double place,
                                         const SE3& world_from_scene, Map& map) {
  map.add_camera(scene.camera());
  std::vector<KeyframeId> ids;
  std::map<int, PointId> point_of;
  for (int i = 0; i < count; ++i) {
    const SE3 pose = PointScene::pose(static_cast<double>(i) / count);
    std::vector<int> source;
    const FramePtr frame = scene.frame(i, pose, 0.2, 0.8, &source);
    const KeyframeId id =
        map.add_keyframe(with_global(frame, global_at(place + 0.02 * i)), world_from_scene * pose,
                         ids.empty() ? kNoId : ids.back());
    bind_to_points(id, source, scene, world_from_scene, point_of, map);
    ids.push_back(id);
  }
  for (const auto& entry : point_of) map.refresh_point(entry.second);
  return ids;
}

}  // namespace dxslam
