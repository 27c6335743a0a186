// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "slam/tracked_poses.h"

#include <algorithm>
#include <unordered_map>

namespace dxslam {
namespace {

constexpr std::size_t kFramesAtOnce = 512;  // read while tracking may have to wait

}  // namespace

void TrackedPoses::append(const TrackedFrame& frame) {
  const std::lock_guard lock(mutex_);
  frames_.append(frame);
}

void TrackedPoses::add_root(const Frame& frame, KeyframeId keyframe) {
  const std::lock_guard lock(mutex_);
  roots_.push_back({frame.index, frame.stamp, keyframe});
}

TrackedPoses::Frames TrackedPoses::tracked_so_far() const {
  Frames all;
  std::size_t end = 0;
  {
    const std::lock_guard lock(mutex_);
    end = frames_.size();
  }
  for (std::size_t next = 0; next < end;) {
    const Frames some = some_from(next);
    all.insert(all.end(), some.begin(), some.end());
  }
  return all;
}

TrackedPoses::Frames TrackedPoses::some_from(std::size_t& next) const {
  const std::lock_guard lock(mutex_);
  Frames some;
  const std::size_t end = std::min(frames_.size(), next + kFramesAtOnce);
  for (; next < end; ++next) {
    const TrackedFrame frame = frames_[next];
    if (frame.state != TrackingState::kTracking) continue;
    const KeyframeId reference = reference_of(frame);
    if (reference == kNoId) continue;
    some.push_back({frame.index, frame.stamp, reference, frame.reference_from_camera});
  }
  return some;
}

std::vector<FramePose> TrackedPoses::poses_of(const Frames& frames, const Map& map) {
  struct Place {
    std::uint32_t component;
    SE3 world_from_reference;
  };
  std::unordered_map<KeyframeId, Place> places;  // many frames hang on one keyframe
  std::vector<FramePose> poses;
  poses.reserve(frames.size());
  for (const Hanging& frame : frames) {
    auto found = places.find(frame.reference);
    if (found == places.end()) {
      const Map::Anchor anchor = map.anchor_of(frame.reference);
      const Keyframe& keyframe = map.keyframe(anchor.keyframe);
      const Place place{keyframe.component, keyframe.world_from_camera * anchor.anchor_from_camera};
      found = places.emplace(frame.reference, place).first;
    }
    poses.push_back({frame.index, frame.stamp, found->second.component,
                     found->second.world_from_reference * frame.reference_from_camera});
  }
  return poses;
}

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
