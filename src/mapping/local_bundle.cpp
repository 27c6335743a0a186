// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "mapping/local_bundle.h"

#include <algorithm>
#include <unordered_map>

namespace dxslam {
namespace {

class BundleBuilder {
 public:
  explicit BundleBuilder(const Map& map) : map_(map) { bundle_.problem.rig = map.rig(); }

  void add_keyframe(KeyframeId id, bool fixed) {
    if (!pose_of_.emplace(id, static_cast<int>(bundle_.keyframes.size())).second) return;
    bundle_.keyframes.push_back(id);
    const Keyframe& k = map_.keyframe(id);
    bundle_.problem.poses.push_back({k.world_from_camera, fixed, k.frame->camera});
    if (bundle_.free_keyframes + 1 == bundle_.keyframes.size() && !fixed) ++bundle_.free_keyframes;
  }

  void add_points_of(KeyframeId id) {
    for (const PointId p : map_.keyframe(id).points) {
      if (p == kNoId || map_.point(p).observations.size() < 2) continue;
      if (point_of_.emplace(p, static_cast<int>(bundle_.points.size())).second) {
        bundle_.points.push_back(p);
        bundle_.problem.points.push_back(map_.point(p).position);
      }
    }
  }

  // The keyframes outside that see most of the points.
  std::vector<KeyframeId> border(std::size_t most) const {
    std::unordered_map<KeyframeId, int> seen;
    for (const PointId p : bundle_.points) {
      for (const PointObservation& o : map_.point(p).observations) {
        if (pose_of_.count(o.keyframe) == 0) ++seen[o.keyframe];
      }
    }
    std::vector<std::pair<int, KeyframeId>> ranked;
    for (const auto& [id, count] : seen) ranked.emplace_back(-count, id);
    std::sort(ranked.begin(), ranked.end());
    if (ranked.size() > most) ranked.resize(most);
    std::vector<KeyframeId> ids;
    for (const auto& [count, id] : ranked) ids.push_back(id);
    return ids;
  }

  LocalBundle finish() {
    for (std::size_t i = 0; i < bundle_.points.size(); ++i) {
      for (const PointObservation& o : map_.point(bundle_.points[i]).observations) {
        const auto pose = pose_of_.find(o.keyframe);
        if (pose != pose_of_.end()) add_observation(pose->second, static_cast<int>(i), o);
      }
    }
    return std::move(bundle_);
  }

 private:
  void add_observation(int pose, int point, const PointObservation& o) {
    const Keyframe& k = map_.keyframe(o.keyframe);
    const Eigen::Vector3d p =
        k.world_from_camera.inverse() * bundle_.problem.points[static_cast<std::size_t>(point)];
    bundle_.problem.observations.push_back(
        {pose, point, measurement_of(*k.frame, o.keypoint, map_.camera_of(o.keyframe), p.z())});
  }

  const Map& map_;
  LocalBundle bundle_;
  std::unordered_map<KeyframeId, int> pose_of_;
  std::unordered_map<PointId, int> point_of_;
};

LocalBundle gather_bundle_of(const Map& map, const std::vector<KeyframeId>& ids) {
  BundleBuilder builder(map);
  for (const KeyframeId id : ids) {
    if (map.keyframe(id).parent != kNoId) builder.add_keyframe(id, false);
  }
  for (const KeyframeId id : ids) builder.add_keyframe(id, map.keyframe(id).parent == kNoId);
  for (const KeyframeId id : ids) builder.add_points_of(id);
  return builder.finish();
}

}  // namespace

LocalBundle gather_local_bundle(const Map& map, KeyframeId keyframe,
                                const MappingOptions& options) {
  BundleBuilder builder(map);
  std::vector<KeyframeId> free = {keyframe};
  for (const Covisible& c :
       map.best_covisibles(keyframe, static_cast<std::size_t>(options.bundle_keyframes - 1),
                           options.bundle_min_shared)) {
    free.push_back(c.keyframe);
  }
  // The first keyframe is the world frame: it never moves.
  std::stable_partition(free.begin(), free.end(),
                        [&](KeyframeId id) { return map.keyframe(id).parent != kNoId; });
  for (const KeyframeId id : free) builder.add_keyframe(id, map.keyframe(id).parent == kNoId);
  for (const KeyframeId id : free) builder.add_points_of(id);
  for (const KeyframeId id :
       builder.border(static_cast<std::size_t>(options.bundle_fixed_keyframes))) {
    builder.add_keyframe(id, true);
  }
  return builder.finish();
}

LocalBundle gather_full_bundle(const Map& map) { return gather_bundle_of(map, map.keyframe_ids()); }

LocalBundle gather_component_bundle(const Map& map, std::uint32_t component) {
  std::vector<KeyframeId> ids = map.keyframe_ids();
  const auto elsewhere = [&](KeyframeId id) { return map.keyframe(id).component != component; };
  ids.erase(std::remove_if(ids.begin(), ids.end(), elsewhere), ids.end());
  return gather_bundle_of(map, ids);
}

int apply_local_bundle(const LocalBundle& bundle, const BundleReport& report, Map& map) {
  for (std::size_t i = 0; i < bundle.keyframes.size(); ++i) {
    if (!bundle.problem.poses[i].fixed) {
      map.set_pose(bundle.keyframes[i], bundle.problem.poses[i].world_from_camera);
    }
  }
  for (std::size_t i = 0; i < bundle.points.size(); ++i) {
    map.set_position(bundle.points[i], bundle.problem.points[i]);
  }
  int outliers = 0;
  for (std::size_t i = 0; i < report.inlier.size(); ++i) {
    if (report.inlier[i] != 0) continue;
    const BundleProblem::Observation& o = bundle.problem.observations[i];
    map.remove_observation(bundle.points[static_cast<std::size_t>(o.point)],
                           bundle.keyframes[static_cast<std::size_t>(o.pose)]);
    ++outliers;
  }
  for (const PointId p : bundle.points) {
    if (map.has_point(p)) map.refresh_point(p);
  }
  return outliers;
}

}  // namespace dxslam
