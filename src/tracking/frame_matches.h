// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/camera.h"
#include "map/local_map.h"
#include "optimization/pose_optimizer.h"

namespace dxslam {

/// A keypoint of the current frame that is taken for a known point.
struct KnownPoint {
  int keypoint = 0;
  PointId id = kNoId;  ///< kNoId: a temporary point from the last frame's depth
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< in world
};

/// The last frame with what was known about it.
struct LastFrame {
  FramePtr frame;
  SE3 world_from_camera;
  std::vector<PointId> points;  ///< one per keypoint; kNoId: none
  Camera camera;
};

/// Known points of a frame: the map point of each keypoint where it has one in the local map,
/// else the keypoint's own depth. One per keypoint that has either, by rising keypoint.
std::vector<KnownPoint> known_points(const LastFrame& last, const LocalMap& local);

/// Observations of `frame` for the pose optimiser.
std::vector<PoseObservation> pose_observations(const Frame& frame,
                                               const std::vector<KnownPoint>& known,
                                               const Camera& camera);

/// Takes the disparity out of the outliers where it disagrees with the pose of `report`. Returns
/// how many.
int drop_wrong_depths(const Camera& camera, const PoseReport& report,
                      std::vector<PoseObservation>& observations);

/// How many of the points `world_from_camera` puts within `radius` pixels of their keypoints.
int count_near(const Camera& camera, const Frame& frame, const SE3& world_from_camera,
               const std::vector<KnownPoint>& known, double radius);

/// How many of the points `world_from_camera` puts into view.
int count_in_view(const Camera& camera, const SE3& world_from_camera,
                  const std::vector<KnownPoint>& known);

/// Drops the entries whose flag is 0.
template <class T>
void keep_inliers(std::vector<T>& items, const std::vector<char>& inlier) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (inlier[i] != 0) items[kept++] = items[i];
  }
  items.resize(kept);
}

}  // namespace dxslam
