// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/frame.h"
#include "core/se3.h"
#include "map/map_types.h"
#include "tracking/tracking_types.h"

namespace dxslam {

// What happens inside the system, as one stream of messages (event_stream.h). Each is made once,
// never changed, and shared by all who read it.

/// The images from now on are of another recording than those before.
struct RecordingBegun {
  int number = 0;  ///< from 0
};

/// Tracking has worked on a frame, found its pose or not.
struct FrameTracked {
  TrackedFrame frame;
  double extract_ms = 0.0;
  double track_ms = 0.0;  ///< looking for its place in the map included
};

/// Why a frame has no pose.
enum class LossReason { kNoPose, kPlaceUnknown };

/// The first frame without a pose after one that had one.
struct TrackingLost {
  double stamp = 0.0;  ///< seconds
  LossReason reason = LossReason::kNoPose;
};

/// A frame was found in the map by itself.
struct PlaceFound {
  double stamp = 0.0;
  std::uint32_t component = 0;
  KeyframeId reference = kNoId;
  SE3 world_from_camera;
  double confidence = 0.0;  ///< as in RelocalizationReport
};

/// A pose of a keyframe, in the world of its component.
struct KeyframePose {
  KeyframeId id = kNoId;
  std::uint32_t component = 0;
  double stamp = 0.0;
  SE3 world_from_camera;
};

/// A position of a point, in the world of its component.
struct PointPosition {
  PointId id = kNoId;
  std::uint32_t component = 0;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
};

/// What one step of mapping did to the map. Together these messages give the whole map: who starts
/// later begins with System::whole_map().
struct MapChanged {
  std::vector<KeyframePose> added_keyframes;
  std::vector<KeyframePose> moved_keyframes;
  std::vector<KeyframeId> removed_keyframes;
  std::vector<PointPosition> added_points;
  std::vector<PointPosition> moved_points;
  std::vector<PointId> removed_points;
  /// Poses given before are not what the map says now: a loop was closed, or maps were joined, and
  /// all of it moved. Else only the neighbourhood of the newest keyframe was refined.
  bool is_correction = false;
};

/// A loop candidate was looked at.
struct LoopConsidered {
  KeyframeId query = kNoId;
  KeyframeId candidate = kNoId;
  bool closed = false;
  std::string verdict;        ///< "accepted", or why not
  std::string effect;         ///< on the map: none, weld, bend or join (then two maps are one)
  double largest_move = 0.0;  ///< metres, of a keyframe
};

/// An autosave has written the map, whole, to a file.
struct MapSaved {
  std::string path;
};

/// The run has ended with an error; nothing follows.
struct RunFailed {
  std::string what;
};

using Event = std::variant<RecordingBegun, FrameTracked, TrackingLost, PlaceFound, MapChanged,
                           LoopConsidered, MapSaved, RunFailed>;

/// An event with its place in the stream.
struct Message {
  std::uint64_t number = 0;  ///< rises by one per message, from 1
  /// Of the map, rises with each MapChanged; what a frame was tracked with may be one or two older.
  std::uint64_t map_version = 0;
  Event event;
};

using MessagePtr = std::shared_ptr<const Message>;

}  // namespace dxslam
