// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "slam/tracked_poses.h"

#include <algorithm>

namespace dxslam {

std::vector<ComponentSummary> TrackedPoses::components(const Map& map) const {
  std::vector<ComponentSummary> all(map.component_count());
  for (std::size_t c = 0; c < all.size(); ++c) all[c].component = static_cast<std::uint32_t>(c);
  for (const KeyframeId id : map.keyframe_ids()) ++all[map.keyframe(id).component].keyframes;
  for (const PointId id : map.point_ids()) {
    const KeyframeId seen_by = map.point(id).observations.front().keyframe;
    ++all[map.keyframe(seen_by).component].points;
  }
  frames_.for_each([&](const TrackedFrame& frame) {
    if (const auto component = component_of(frame, map)) ++all[*component].frames;
  });
  const auto joined = [](const ComponentSummary& c) { return c.keyframes == 0; };
  all.erase(std::remove_if(all.begin(), all.end(), joined), all.end());
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) {
    return a.frames != b.frames ? a.frames > b.frames : a.keyframes > b.keyframes;
  });
  return all;
}

Trajectory TrackedPoses::trajectory(const Map& map, std::uint32_t component) const {
  Trajectory trajectory;
  frames_.for_each([&](const TrackedFrame& frame) {
    if (component_of(frame, map) != component) return;
    const Map::Anchor anchor = map.anchor_of(reference_of(frame));
    trajectory.push_back(
        {frame.stamp, map.keyframe(anchor.keyframe).world_from_camera * anchor.anchor_from_camera *
                          frame.reference_from_camera});
  });
  return trajectory;
}

// A frame that began a map was tracked before there was a keyframe to hang on.
KeyframeId TrackedPoses::reference_of(const TrackedFrame& frame) const {
  if (frame.state != TrackingState::kTracking || frame.reference != kNoId) return frame.reference;
  const auto began = std::find_if(roots_.begin(), roots_.end(), [&](const Root& root) {
    return root.index == frame.index && root.stamp == frame.stamp;
  });
  return began == roots_.end() ? kNoId : began->keyframe;
}

std::optional<std::uint32_t> TrackedPoses::component_of(const TrackedFrame& frame,
                                                        const Map& map) const {
  if (frame.state != TrackingState::kTracking) return std::nullopt;
  const KeyframeId reference = reference_of(frame);
  if (reference == kNoId) return std::nullopt;
  return map.keyframe(map.anchor_of(reference).keyframe).component;
}

Trajectory keyframe_poses(const Map& map, std::uint32_t component) {
  Trajectory trajectory;
  for (const KeyframeId id : map.keyframe_ids()) {
    const Keyframe& keyframe = map.keyframe(id);
    if (keyframe.component != component) continue;
    trajectory.push_back({keyframe.frame->stamp, keyframe.world_from_camera});
  }
  return trajectory;
}

}  // namespace dxslam
