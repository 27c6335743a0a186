// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <vector>

#include "core/camera.h"
#include "core/features.h"
#include "map/map.h"
#include "matching/keypoint_grid.h"
#include "relocalization/relocalization_options.h"

namespace dxslam {

/// A keypoint that is taken for a map point.
struct PointMatch {
  int keypoint = 0;
  PointId id = kNoId;
};

/// A pose with the matches that agree with it.
struct RefinedPose {
  SE3 world_from_camera;
  std::vector<PointMatch> inliers;
  KeyframeId reference = kNoId;  ///< sees most of the inliers
  int visible = 0;               ///< points of the local map that should be in view
  double coverage = 0.0;         ///< as in RelocalizationReport
  double rms_pixels = 0.0;
};

/// Brings a rough pose of a frame and its first matches to what tracking would have found: motion-
/// only adjustment, then twice a search of the points of the wider local map around their
/// projections, wide and narrow, with an adjustment each. One object serves one frame and one map,
/// neither of which may change or go away meanwhile.
class PoseRefiner {
 public:
  PoseRefiner(const Camera& camera, const DescriptorTraits& traits,
              const RelocalizationOptions& options, const Map& map, const Frame& frame);

  /// False if too few points agree on any pose; `pose` is then undefined.
  bool refine(RefinedPose& pose) const;

 private:
  bool optimise(RefinedPose& pose) const;
  KeyframeId best_reference(const std::vector<PointMatch>& matches) const;
  std::vector<PointId> local_points(KeyframeId reference) const;
  /// Adds the points that are found; returns the pixels of those that should be in view.
  std::vector<Eigen::Vector2f> search(const std::vector<PointId>& points, double radius,
                                      RefinedPose& pose) const;
  double coverage(const std::vector<Eigen::Vector2f>& in_view,
                  const std::vector<PointMatch>& inliers) const;

  const Camera& camera_;
  const DescriptorTraits& traits_;
  const RelocalizationOptions& options_;
  const Map& map_;
  const Frame& frame_;
  KeypointGrid grid_;
};

}  // namespace dxslam
