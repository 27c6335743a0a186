// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <vector>

#include "core/camera.h"
#include "core/features.h"
#include "core/frame.h"
#include "map/map.h"
#include "place/global_index.h"
#include "relocalization/relocalization_options.h"

namespace dxslam {

/// What relocalization found for one frame.
struct RelocalizationReport {
  /// The pose may be relied on.
  bool accepted = false;
  /// There is a pose, accepted or not: the best hypothesis.
  bool has_pose = false;
  SE3 world_from_camera;         ///< in the world of `component`
  std::uint32_t component = 0;   ///< of the map
  KeyframeId reference = kNoId;  ///< the keyframe that shares most points with the frame
  double confidence = 0.0;       ///< calibrated probability that the pose is right, 0 to 1

  int groups_tried = 0;
  int matches = 0;  ///< of the group's points by descriptor alone
  int matched = 0;  ///< those of them that agree with the refined pose
  int visible = 0;  ///< map points that should be in view
  int inliers = 0;  ///< map points that agree with the refined pose
  /// Of the inliers: standard deviation of the pixels along their narrowest direction, relative to
  /// the diagonal of the image.
  double spread = 0.0;
  /// Of the parts of the image in which the frame has keypoints and the map has points that should
  /// be in view: the share with an inlier. A thing that is there twice agrees in one place alone.
  double coverage = 0.0;
  double rms_pixels = 0.0;      ///< of the inliers
  std::vector<PointId> points;  ///< the inlier of each keypoint, kNoId: none; empty without a pose

  /// Share of the points in view that were found.
  double ratio() const { return visible > 0 ? static_cast<double>(inliers) / visible : 0.0; }
};

/// Finds the pose of a single frame in a map without any idea where it is (paper III.D):
///   1. the keyframes most alike by global descriptor, grouped by covisibility;
///   2. for each group, the most promising first: the frame's keypoints against all points of the
///      group at once, RANSAC with P3P (or the frame's depth), refinement against the wider local
///      map by projection and motion-only adjustment;
///   3. the first pose that passes AcceptanceOptions is taken.
/// Immutable and without state: any number of threads may use one, as long as nobody changes the
/// map or the index meanwhile. Deterministic.
class Relocalizer {
 public:
  /// Throws InputError for options out of range.
  Relocalizer(const Camera& camera, const DescriptorTraits& traits,
              const RelocalizationOptions& options = {});

  /// With candidates by the frame's global descriptor. Nothing is found without one.
  RelocalizationReport relocalize(const Map& map, const GlobalIndex& index,
                                  const Frame& frame) const;
  /// With candidates from elsewhere (a bag of words), best first.
  RelocalizationReport relocalize(const Map& map, const std::vector<GlobalMatch>& candidates,
                                  const Frame& frame) const;

  const RelocalizationOptions& options() const { return options_; }

 private:
  Camera camera_;
  DescriptorTraits traits_;
  RelocalizationOptions options_;
};

/// Index of all keyframes of a map whose frames carry a global descriptor.
GlobalIndex index_keyframes(const Map& map);

}  // namespace dxslam
