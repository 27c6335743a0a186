// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "core/camera.h"
#include "core/features.h"
#include "core/pause.h"
#include "map/local_map.h"
#include "map/map.h"
#include "mapping/mapping_options.h"
#include "mapping/mapping_report.h"
#include "optimization/may_go_on.h"
#include "tracking/tracking_types.h"

namespace dxslam {

/// Calls what it is given, which changes the map; to know when that is.
using MapChange = std::function<void(const std::function<void()>&)>;

/// Grows and refines the map, keyframe by keyframe (paper III.A, "Local mapping"). Owns the map.
/// Belongs to one thread; others see the map through local_map().
class LocalMapper {
 public:
  LocalMapper(const Camera& camera, const DescriptorTraits& traits, const MappingOptions& options,
              Pause pause = {});

  /// Puts the requested keyframe into the map with its matches and new points from depth. Quick;
  /// afterwards local_map() is what tracking should use until refine() is through.
  MappingReport insert(const KeyframeRequest& request);
  /// Second half, for the keyframe inserted last: fuse with neighbours, triangulate, adjust the
  /// local bundle, cull. `report` is the one insert() returned.
  void refine(MappingReport& report);

  /// Adjusts all keyframes and points together. Returns the observations unbound as outliers.
  /// Leaves the map as it is where `may_go_on` says no. All that changes the map is done in one
  /// call of `change`.
  int adjust_full_bundle(const BundleOptions& options, const MayGoOn& may_go_on,
                         const MapChange& change);

  /// What comes from now on is of another recording than the map so far.
  void begin_recording();

  /// Snapshot around a keyframe.
  LocalMapPtr local_map_around(KeyframeId keyframe) const;
  /// Snapshot around the newest keyframe. There must be one.
  LocalMapPtr local_map() const { return local_map_around(map_.last_keyframe()); }
  const Map& map() const { return map_; }
  /// For those who change the map between the calls above, in the same thread: loop closing.
  Map& map() { return map_; }
  /// Goes on with a map made before, in place of an empty one.
  void set_map(Map map) {
    map_ = std::move(map);
    camera_id_ = map_.add_camera(camera_);
  }
  /// What the frames of keyframes to be inserted must say of their camera.
  CameraId camera_id() const { return camera_id_; }

 private:
  struct Recent {
    PointId point;
    KeyframeId created_by;
  };
  void pause() const {
    if (pause_) pause_();
  }
  void bind_matches(const KeyframeRequest& request, KeyframeId keyframe);
  int create_points_from_depth(KeyframeId keyframe);
  int create_points_by_triangulation(KeyframeId keyframe);
  int fuse_with_neighbours(KeyframeId keyframe);
  int cull_recent_points();
  std::vector<KeyframeId> cull_keyframes(KeyframeId newest);
  bool is_redundant(const Keyframe& k) const;
  void adjust_local_bundle(KeyframeId keyframe, MappingReport& report);

  Camera camera_;
  DescriptorTraits traits_;
  MappingOptions options_;
  Pause pause_;
  Map map_;
  CameraId camera_id_ = 0;
  std::vector<Recent> recent_;
  KeyframeId first_of_recording_ = 0;
};

}  // namespace dxslam
