// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "tracking/frame_matches.h"

#include <algorithm>

namespace dxslam {

std::vector<KnownPoint> known_points(const LastFrame& last, const LocalMap& local) {
  std::vector<KnownPoint> known;
  known.reserve(last.frame->size());
  for (std::size_t i = 0; i < last.frame->size(); ++i) {
    const int keypoint = static_cast<int>(i);
    const int index = last.points[i] == kNoId ? -1 : local.find(last.points[i]);
    if (index >= 0) {
      known.push_back({keypoint, last.points[i], local.positions[static_cast<std::size_t>(index)]});
    } else if (last.frame->has_depth(i)) {
      const Eigen::Vector3d in_camera = last.camera.unproject(
          last.frame->pixels[i].cast<double>(), static_cast<double>(last.frame->depths[i]));
      known.push_back({keypoint, kNoId, last.world_from_camera * in_camera});
    }
  }
  return known;
}

std::vector<PoseObservation> pose_observations(const Frame& frame,
                                               const std::vector<KnownPoint>& known,
                                               const Camera& camera) {
  std::vector<PoseObservation> observations;
  observations.reserve(known.size());
  for (const KnownPoint& k : known) {
    const std::size_t i = static_cast<std::size_t>(k.keypoint);
    observations.push_back({k.position, measurement_of(frame, i, camera)});
  }
  return observations;
}

int drop_wrong_depths(const Camera& camera, const PoseReport& report,
                      std::vector<PoseObservation>& observations) {
  const SE3 camera_from_world = report.world_from_camera.inverse();
  int dropped = 0;
  for (std::size_t i = 0; i < observations.size(); ++i) {
    PoseObservation& o = observations[i];
    if (report.inlier[i] != 0 || !o.measured.has_disparity()) continue;
    const double z = (camera_from_world * o.point_in_world).z();
    if (o.measured.disparity_agrees(camera, z)) continue;
    o.measured.drop_disparity();
    ++dropped;
  }
  return dropped;
}

int count_near(const Camera& camera, const Frame& frame, const SE3& world_from_camera,
               const std::vector<KnownPoint>& known, double radius) {
  const SE3 camera_from_world = world_from_camera.inverse();
  return static_cast<int>(std::count_if(known.begin(), known.end(), [&](const KnownPoint& k) {
    const Eigen::Vector2d pixel = frame.pixels[static_cast<std::size_t>(k.keypoint)].cast<double>();
    const double within = radius * camera.stretch(pixel);
    return camera.squared_error(camera_from_world * k.position, pixel) <= within * within;
  }));
}

int count_in_view(const Camera& camera, const SE3& world_from_camera,
                  const std::vector<KnownPoint>& known) {
  const SE3 camera_from_world = world_from_camera.inverse();
  return static_cast<int>(std::count_if(known.begin(), known.end(), [&](const KnownPoint& k) {
    return camera.project_into_view(camera_from_world * k.position).has_value();
  }));
}

}  // namespace dxslam
