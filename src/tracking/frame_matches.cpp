// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "tracking/frame_matches.h"

namespace dxslam {

std::vector<KnownPoint> known_points(const LastFrame& last, const LocalMap& local,
                                     const Camera& camera) {
  std::vector<KnownPoint> known;
  known.reserve(last.frame->size());
  for (std::size_t i = 0; i < last.frame->size(); ++i) {
    const int keypoint = static_cast<int>(i);
    const int index = last.points[i] == kNoId ? -1 : local.find(last.points[i]);
    if (index >= 0) {
      known.push_back({keypoint, last.points[i], local.positions[static_cast<std::size_t>(index)]});
    } else if (last.frame->has_depth(i)) {
      const Eigen::Vector3d in_camera = camera.unproject(
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
    observations.push_back({k.position, frame.pixels[i].cast<double>(),
                            disparity_of(frame, i, camera), static_cast<double>(frame.sigmas[i])});
  }
  return observations;
}

}  // namespace dxslam
