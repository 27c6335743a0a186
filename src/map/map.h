// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "core/rig.h"
#include "map/id_table.h"
#include "map/map_journal.h"
#include "map/map_types.h"
#include "map/removed_keyframes.h"

namespace dxslam {

struct MapParts;

/// Keyframes and points, and who sees what. The map owns both, in memory for what lives in it, and
/// is the only place that changes observations and covisibility, so that the two always agree.
/// Not thread-safe: one thread owns a map, others get snapshots (local_map.h).
class Map {
 public:
  Map() = default;
  /// Puts a map together again (map_parts.h): what the points say of their observations is taken as
  /// it is and the rest follows, without looking at descriptors. Throws ContractError naming the
  /// first relation that does not hold.
  explicit Map(MapParts parts);

  /// The id of a camera for the frames that it takes; added to the rig where it is not there.
  CameraId add_camera(const Camera& camera) { return rig_.add(camera); }
  const Rig& rig() const { return rig_; }
  /// The camera that took a keyframe. Throws ContractError where there is no such keyframe, or its
  /// frame names a camera that was not added.
  const Camera& camera_of(KeyframeId id) const { return rig_[keyframe(id).frame->camera]; }

  /// Adds a keyframe without points. `parent` must exist, or be kNoId for the first one of a new
  /// component.
  KeyframeId add_keyframe(FramePtr frame, const SE3& world_from_camera, KeyframeId parent);
  /// Adds a point first seen by keypoint `keypoint` of `keyframe`, which must be free.
  PointId add_point(const Eigen::Vector3d& position, KeyframeId keyframe, std::uint32_t keypoint);
  /// Binds a free keypoint to a point not yet seen by that keyframe.
  /// Returns false, changing nothing, if either is taken.
  bool add_observation(PointId point, KeyframeId keyframe, std::uint32_t keypoint);
  /// Unbinds; a point left with no observation is removed.
  void remove_observation(PointId point, KeyframeId keyframe);
  void remove_point(PointId point);
  /// Moves the observations of `from` to `to` where `to` has none in that keyframe, adds up the
  /// counters and removes `from`.
  void merge_points(PointId from, PointId to);
  /// Removes a keyframe and its observations; its children in the tree go to its parent, and its
  /// pose relative to the parent stays on record (anchor_of). The first keyframe of a component
  /// cannot be removed.
  void remove_keyframe(KeyframeId keyframe);
  /// Joins two components: moves the keyframes and points of the one of `child` by
  /// `parent_world_from_child_world` and hangs its tree on `parent`, with `child` as the new joint.
  /// Both must exist and be of different components.
  void join_components(KeyframeId parent, KeyframeId child,
                       const SE3& parent_world_from_child_world);

  /// Whether what is done from now on is taken down for take_changes(); off at first.
  void record_changes(bool on) {
    keyframe_journal_.keep(on);
    point_journal_.keep(on);
  }
  bool records_changes() const { return keyframe_journal_.is_kept(); }
  /// What has changed since this was called last; nothing where it is not recorded.
  MapChanges take_changes();

  bool has_keyframe(KeyframeId id) const { return keyframes_.find(id) != nullptr; }
  bool has_point(PointId id) const { return points_.find(id) != nullptr; }
  /// Throw ContractError for ids that do not exist (any more).
  const Keyframe& keyframe(KeyframeId id) const;
  const MapPoint& point(PointId id) const;

  void set_pose(KeyframeId id, const SE3& world_from_camera);
  void set_position(PointId id, const Eigen::Vector3d& position);
  /// Adds to the counters that decide whether a point is worth keeping.
  void count_visible(PointId id, std::uint32_t visible, std::uint32_t found);
  /// Brings normal, distance and descriptor up to date with the observations: the descriptor is the
  /// one closest to all others (medoid) of at most eight observations spread over all.
  void refresh_point(PointId id);

  /// Ids of all living keyframes and points, rising.
  std::vector<KeyframeId> keyframe_ids() const;
  std::vector<PointId> point_ids() const;
  std::size_t keyframe_count() const { return keyframes_.size(); }
  std::size_t point_count() const { return points_.size(); }
  KeyframeId last_keyframe() const { return last_keyframe_; }
  /// Components ever started; some may have been joined to others.
  std::uint32_t component_count() const { return component_count_; }
  /// The descriptor that stands for a point: a row of the frame it was seen in.
  cv::Mat descriptor_of(PointId id) const;

  /// The n keyframes that share most points with `id`, by falling number (ties: newer first).
  std::vector<Covisible> best_covisibles(KeyframeId id, std::size_t n, int min_shared) const;

  /// A living keyframe and the pose relative to it.
  struct Anchor {
    KeyframeId keyframe = kNoId;
    SE3 anchor_from_camera;
  };
  /// Where `id`, removed or not, hangs now: itself, or the nearest living ancestor. Throws
  /// InputError if that is on the disk (removed_keyframes.h) and cannot be read.
  Anchor anchor_of(KeyframeId id) const;

 private:
  Keyframe& mutable_keyframe(KeyframeId id);
  MapPoint& mutable_point(PointId id);
  void change_covisibility(const MapPoint& point, KeyframeId keyframe, int change);
  void bind_observations(const MapPoint& point);
  void count_covisibility();

  Rig rig_;
  Journal keyframe_journal_;
  Journal point_journal_;
  IdTable<Keyframe> keyframes_;
  IdTable<MapPoint> points_;
  RemovedKeyframes removed_;
  KeyframeId next_keyframe_ = 0;
  PointId next_point_ = 0;
  KeyframeId last_keyframe_ = kNoId;
  std::uint32_t component_count_ = 0;
};

}  // namespace dxslam
