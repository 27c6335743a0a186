// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstdint>
#include <memory>
#include <opencv2/core.hpp>
#include <vector>

#include "map/map.h"

namespace dxslam {

struct LocalMapOptions {
  int keyframes = 30;
  int nearby_keyframes = 20;
  double nearby_distance = 1.5;
  double nearby_angle = 45.0;
  int max_points = 8000;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit("keyframes", self.keyframes, {1, 1000}, "keyframes",
          "most keyframes taken by covisibility");
    visit("nearby_keyframes", self.nearby_keyframes, {0, 1000}, "keyframes",
          "most keyframes taken because they look at the same place, covisible or not");
    visit("nearby_distance", self.nearby_distance, {0, 100}, "m", "farthest nearby keyframe");
    visit("nearby_angle", self.nearby_angle, {0, 180}, "degrees",
          "largest angle to a nearby keyframe");
    visit("max_points", self.max_points, {100, 1000000}, "points", "most points of a local map");
  }
};

/// What tracking needs of the map around one keyframe: a self-contained copy, immutable once made,
/// handed over as std::shared_ptr<const LocalMap>, so that tracking and mapping share no lock.
struct LocalMap {
  KeyframeId reference = kNoId;
  std::uint32_t component = 0;  ///< of all that is in here
  FramePtr reference_frame;
  Camera reference_camera;
  SE3 world_from_reference;
  std::vector<PointId> reference_points;  ///< one per keypoint of the reference; kNoId: none

  std::vector<PointId> ids;                ///< rising
  std::vector<Eigen::Vector3d> positions;  ///< in world
  std::vector<Eigen::Vector3d> normals;    ///< see MapPoint
  std::vector<float> distances;            ///< see MapPoint
  cv::Mat descriptors;                     ///< one row per point

  std::vector<KeyframeId> keyframes;  ///< all that are in here, rising
  std::vector<SE3> keyframe_poses;    ///< world_from_camera of each
  /// world_from_camera of a keyframe in here, or null.
  const SE3* find_pose(KeyframeId id) const;
  std::size_t size() const { return ids.size(); }
  /// Index of a point, or -1.
  int find(PointId id) const;
};

using LocalMapPtr = std::shared_ptr<const LocalMap>;

/// Covisible keyframes of `reference` first, then keyframes that look at the same place.
std::vector<KeyframeId> local_keyframes(const Map& map, KeyframeId reference,
                                        const LocalMapOptions& options);

/// The points that the keyframes see, rising; of more than `most` the newest.
std::vector<PointId> points_of(const Map& map, const std::vector<KeyframeId>& keyframes,
                               std::size_t most);

LocalMapPtr make_local_map(const Map& map, KeyframeId reference, const LocalMapOptions& options);

}  // namespace dxslam
