// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "core/frame.h"
#include "core/se3.h"
#include "map/map_types.h"
#include "mapping/mapping_report.h"
#include "tracking/tracking_types.h"

namespace dxslam {

// What happens inside the system, as one stream of messages (event_stream.h). Each is made once,
// never changed, and shared by all who read it.

/// The images from now on are of this recording; told before its first frame.
struct RecordingBegun {
  int number = 0;  ///< as System::begin_sequence() gave it; 0: the first
};

/// All keyframes of a recording are in the map, or its run has ended.
struct RecordingEnded {
  int number = 0;
  std::size_t keyframes = 0;  ///< of the whole map now
  std::size_t points = 0;
};

/// Tracking has worked on a frame, found its pose or not.
struct FrameTracked {
  TrackedFrame frame;
  /// Of the pose that the image alone is wrong by, against the local map taken for exact: the true
  /// pose is world_from_camera * SE3::exp(e) with e = (translation in metres, rotation in radians)
  /// along the axes of the camera. From the Hessian of the pose's adjustment and the residuals that
  /// are left, so that it holds whatever the noise of the image is. Errors of the map, which frames
  /// in a row share, are not in it. Symmetric, positive definite. None where there is no pose, and
  /// for the frame that begins a map, whose pose is the origin by definition.
  std::optional<Matrix6d> covariance;
  double extract_ms = 0.0;
  double track_ms = 0.0;                ///< looking for its place in the map included
  std::optional<double> relocalize_ms;  ///< of it, looking for the place; none: not looked for
  /// It should have become a keyframe, but mapping was too far behind (live input only).
  bool request_dropped = false;
};

/// Why an image was not worked on.
enum class SkipReason {
  kUnreadable,    ///< told by who reads the images
  kNotExtracted,  ///< extraction failed
  kDropped,       ///< live input only: tracking was too far behind
};
const char* describe(SkipReason reason);

/// An image that there is no FrameTracked of.
struct ImageSkipped {
  std::int64_t index = 0;
  std::optional<double> stamp;  ///< seconds; none where it is not known
  SkipReason reason = SkipReason::kUnreadable;
  std::string what;  ///< one sentence, where there is more to say
};

/// The first frame without a pose, of a recording or after one that had one.
struct TrackingLost {
  double stamp = 0.0;  ///< seconds
  LossReason reason = LossReason::kFewMatches;
  int keypoints = 0;  ///< of the frame
  int matches = 0;    ///< known points found in it, at most
};

/// A frame was found in the map by itself.
struct PlaceFound {
  double stamp = 0.0;
  std::uint32_t component = 0;
  KeyframeId reference = kNoId;
  SE3 world_from_camera;
  double confidence = 0.0;  ///< as in RelocalizationReport
};

/// Mapping has worked a keyframe into the map: what it did, and how long each step took. The poses
/// and positions are in MapChanged.
struct KeyframeMapped {
  std::int64_t frame = 0;  ///< index of its image
  MappingReport report;
  double insert_ms = 0.0;
  double refine_ms = 0.0;
  double loop_closing_ms = 0.0;
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
  /// all of it moved. Else only the neighbourhood of the newest keyframe was refined. What the map
  /// says now, System::all_poses() gives.
  bool is_correction = false;
};

/// A keyframe looks like one from before: geometry says whether it is the same place, in the
/// message that follows (LoopRefused, LoopClosed or MapsJoined).
struct LoopFound {
  KeyframeId query = kNoId;
  KeyframeId candidate = kNoId;
  double bow_score = 0.0;                 ///< of words, 0 to 1
  std::optional<double> global_distance;  ///< of global descriptors; none where there are none
};

/// It is not, or the map and the loops before contradict it.
struct LoopRefused {
  KeyframeId query = kNoId;
  KeyframeId candidate = kNoId;
  std::string reason;
};

/// It is: both ends now see the same points. MapChanged follows.
struct LoopClosed {
  KeyframeId query = kNoId;
  KeyframeId candidate = kNoId;
  double largest_move = 0.0;  ///< metres, of a keyframe; 0 where the map agreed already
};

/// It is, and in another world: the two are one from now on. MapChanged follows.
struct MapsJoined {
  KeyframeId query = kNoId;
  KeyframeId candidate = kNoId;
  std::uint32_t kept_component = 0;
  std::uint32_t joined_component = 0;  ///< is no more: all in it is in the other
};

/// An autosave has written the map, whole, to a file.
struct MapSaved {
  std::string path;
};

/// The run has ended well; nothing follows.
struct RunFinished {
  double final_bundle_ms = 0.0;  ///< the last adjustment of the whole map, and waiting for it
};

/// The run has ended with an error; nothing follows.
struct RunFailed {
  std::string what;
};

using Event = std::variant<RecordingBegun, RecordingEnded, FrameTracked, ImageSkipped, TrackingLost,
                           PlaceFound, KeyframeMapped, MapChanged, LoopFound, LoopRefused,
                           LoopClosed, MapsJoined, MapSaved, RunFinished, RunFailed>;

/// An event with its place in the stream.
struct Message {
  /// Rises by one per message that somebody reads, from 1. Gaps are messages that were lost, or of
  /// kinds that this reader did not ask for.
  std::uint64_t number = 0;
  /// Of the map, rises when it has changed; what a frame was tracked with may be one or two older.
  std::uint64_t map_version = 0;
  Event event;
};

using MessagePtr = std::shared_ptr<const Message>;

/// A set of kinds of events, e.g. EventKinds::of<FrameTracked, MapSaved>().
class EventKinds {
 public:
  static constexpr EventKinds all() { return EventKinds(~std::uint32_t{0}); }
  static constexpr EventKinds none() { return EventKinds(0); }
  template <class... Events>
  static constexpr EventKinds of() {
    return EventKinds((bit(index_of<Events>()) | ...));
  }

  constexpr bool has(const Event& event) const { return (bits_ & bit(event.index())) != 0; }
  constexpr bool has_any(EventKinds others) const { return (bits_ & others.bits_) != 0; }
  constexpr EventKinds operator|(EventKinds others) const {
    return EventKinds(bits_ | others.bits_);
  }

 private:
  constexpr explicit EventKinds(std::uint32_t bits) : bits_(bits) {}
  static constexpr std::uint32_t bit(std::size_t index) { return std::uint32_t{1} << index; }
  template <class Wanted, std::size_t Index = 0>
  static constexpr std::size_t index_of() {
    if constexpr (std::is_same_v<Wanted, std::variant_alternative_t<Index, Event>>) {
      return Index;
    } else {
      return index_of<Wanted, Index + 1>();
    }
  }

  std::uint32_t bits_;
};

}  // namespace dxslam
