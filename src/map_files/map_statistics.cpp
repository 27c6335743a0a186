// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "map_files/map_statistics.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace dxslam {
namespace {

void add_reprojection(const StoredMap& stored, MapStatistics& statistics) {
  const Map& map = stored.map;
  std::vector<double> errors;
  for (const PointId id : map.point_ids()) {
    const MapPoint& p = map.point(id);
    for (const PointObservation& o : p.observations) {
      const Keyframe& k = map.keyframe(o.keyframe);
      const Eigen::Vector3d in_camera = k.world_from_camera.inverse() * p.position;
      const double error2 =
          map.camera_of(k.id).squared_error(in_camera, k.frame->pixels[o.keypoint].cast<double>());
      if (std::isinf(error2)) {
        ++statistics.behind;
      } else {
        errors.push_back(std::sqrt(error2));
      }
    }
    statistics.observations += p.observations.size();
  }
  if (errors.empty()) return;
  const auto quantile = [&](double share) {
    const auto at = errors.begin() +
                    static_cast<std::ptrdiff_t>(share * static_cast<double>(errors.size() - 1));
    std::nth_element(errors.begin(), at, errors.end());
    return *at;
  };
  statistics.median_error = quantile(0.5);
  statistics.p95_error = quantile(0.95);
}

std::size_t covisible_groups(const Map& map) {
  const std::vector<KeyframeId> ids = map.keyframe_ids();
  std::vector<bool> reached(ids.empty() ? 0 : ids.back() + 1, false);
  std::size_t groups = 0;
  for (const KeyframeId start : ids) {
    if (reached[start]) continue;
    ++groups;
    std::vector<KeyframeId> todo = {start};
    reached[start] = true;
    while (!todo.empty()) {
      const KeyframeId id = todo.back();
      todo.pop_back();
      for (const Covisible& c : map.keyframe(id).covisibles) {
        if (reached[c.keyframe]) continue;
        reached[c.keyframe] = true;
        todo.push_back(c.keyframe);
      }
    }
  }
  return groups;
}

}  // namespace

MapStatistics map_statistics(const StoredMap& stored) {
  const Map& map = stored.map;
  MapStatistics statistics;
  statistics.components.resize(map.component_count());
  std::vector<Eigen::AlignedBox3d> boxes(map.component_count());
  for (const KeyframeId id : map.keyframe_ids()) {
    const Keyframe& k = map.keyframe(id);
    ComponentSize& component = statistics.components[k.component];
    const double stamp = k.frame->stamp;
    const bool first = component.keyframes++ == 0;
    component.first_stamp = first ? stamp : std::min(component.first_stamp, stamp);
    component.last_stamp = first ? stamp : std::max(component.last_stamp, stamp);
    boxes[k.component].extend(k.world_from_camera.translation());
    statistics.keypoints += k.frame->size();
    if (!k.frame->global.empty()) ++statistics.globals;
    if (k.covisibles.empty() &&
        std::all_of(k.points.begin(), k.points.end(), [](PointId p) { return p == kNoId; })) {
      ++statistics.blind_keyframes;
    }
  }
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (!boxes[i].isEmpty()) statistics.components[i].extent = boxes[i].diagonal().norm();
  }
  for (const PointId id : map.point_ids()) {
    const KeyframeId seen_by = map.point(id).observations.front().keyframe;
    ++statistics.components[map.keyframe(seen_by).component].points;
  }
  add_reprojection(stored, statistics);
  statistics.covisible_groups = covisible_groups(map);
  return statistics;
}

}  // namespace dxslam
