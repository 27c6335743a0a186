// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstdint>
#include <mutex>
#include <optional>
#include <vector>

#include "core/trajectory.h"
#include "map/map.h"
#include "slam/frame_log.h"

namespace dxslam {

/// Frames and keyframes whose poses are known relative to one another: one map of several.
struct ComponentSummary {
  std::uint32_t component = 0;
  std::size_t keyframes = 0;
  std::size_t points = 0;
  std::size_t frames = 0;  ///< tracked in it
};

/// The pose of a tracked frame, in the world of its component.
struct FramePose {
  std::int64_t index = 0;
  double stamp = 0.0;  ///< seconds
  std::uint32_t component = 0;
  SE3 world_from_camera;
};

/// Every frame of a run, and where a map says that it was. Frames are appended by one thread and
/// roots by another, while others may ask for tracked_so_far(); the rest is for when both are done.
class TrackedPoses {
 public:
  void append(const TrackedFrame& frame);
  /// `keyframe`, made of `frame`, began a component.
  void add_root(const Frame& frame, KeyframeId keyframe);
  const FrameLog& frames() const { return frames_; }

  /// A frame with a pose, and the keyframe that it hangs on.
  struct Hanging {
    std::int64_t index = 0;
    double stamp = 0.0;
    KeyframeId reference = kNoId;
    SE3 reference_from_camera;
  };
  using Frames = std::vector<Hanging>;
  /// All that have a pose so far, in order; without one that begins a map that is not there yet.
  Frames tracked_so_far() const;
  /// Where the map has them.
  static std::vector<FramePose> poses_of(const Frames& frames, const Map& map);

  /// All maps there are, the one with most tracked frames first.
  std::vector<ComponentSummary> components(const Map& map) const;
  /// Poses of the frames tracked in one component, as the map has them.
  Trajectory trajectory(const Map& map, std::uint32_t component) const;

 private:
  /// The keyframe that a component began with, and its image.
  struct Root {
    std::int64_t index = 0;
    double stamp = 0.0;
    KeyframeId keyframe = kNoId;
  };
  KeyframeId reference_of(const TrackedFrame& frame) const;
  std::optional<std::uint32_t> component_of(const TrackedFrame& frame, const Map& map) const;
  Frames some_from(std::size_t& next) const;

  mutable std::mutex mutex_;
  FrameLog frames_;          // guarded by mutex_ while they are appended
  std::vector<Root> roots_;  // likewise
};

/// Poses of the keyframes of one component.
Trajectory keyframe_poses(const Map& map, std::uint32_t component);

}  // namespace dxslam
