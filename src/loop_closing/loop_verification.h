// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstdint>
#include <vector>

#include "core/camera.h"
#include "core/features.h"
#include "core/se3.h"
#include "loop_closing/loop_closing_options.h"
#include "map/map.h"

namespace dxslam {

/// Why two keyframes are not taken for the same place, in the order in which it is asked.
enum class LoopRejection {
  kNone,
  kGone,          ///< the candidate is no longer in the map
  kConnected,     ///< the two share points already
  kFewPoints,     ///< too few points around the candidate
  kFewMatches,    ///< too few descriptors match
  kNoPose,        ///< the matches agree on no pose
  kFewInliers,    ///< too few points lie where the pose puts them
  kManyOutliers,  ///< too many matched near their pixel but not at it
  kFewFound,      ///< most points that should be in view were not found
  kNarrow,        ///< what was found fills too little of the image
  kDepth,         ///< measured depths contradict the pose
  kUnconfirmed,   ///< the neighbours of the query do not see the place
};
/// In words for a log: "too few descriptors match".
const char* describe(LoopRejection rejection);

/// A keypoint of the query is an image of a point of the candidate's group.
struct LoopMatch {
  std::uint32_t keypoint = 0;
  PointId point = kNoId;
};

/// What the geometry says about two keyframes. Fields after the rejecting step are as at the start.
struct LoopVerification {
  KeyframeId query = kNoId;
  KeyframeId candidate = kNoId;
  bool accepted = false;
  LoopRejection rejection = LoopRejection::kNone;

  int points = 0;              ///< sought
  int matches = 0;             ///< by descriptor alone
  int pose_inliers = 0;        ///< of these, with the pose found
  int guided_matches = 0;      ///< near the pixel predicted by that pose
  int inliers = 0;             ///< of these, after refinement
  int expected = 0;            ///< points that should be in view
  double found_share = 0.0;    ///< see LoopVerificationOptions
  int cells = 0;               ///< of the image in which there are inliers
  double covered_share = 0.0;  ///< of the cells in which points are due
  double depth_share = 0.0;    ///< of points at their pixel, with the right depth; 1 without depths
  int confirming = 0;          ///< neighbours of the query that should see the place
  int confirmations = 0;       ///< neighbours that do
  double rms_pixels = 0.0;     ///< over inliers

  SE3 candidate_from_query;  ///< valid if accepted; lengths are those of the candidate's points
  /// Lengths around the candidate over lengths around the query: the drift in scale. 1 where it
  /// cannot be told; of interest for maps made without depth.
  double scale = 1.0;
  std::vector<LoopMatch> inlier_matches;  ///< by rising keypoint
};

/// Whether `query` shows the place around `candidate`, of the same or another component, told by
/// geometry alone: descriptors are matched with the points of the candidate's neighbourhood, RANSAC
/// finds a pose, the points are sought again where it puts them, and the pose is refined. Takes
/// nothing from the relative pose that the map believes in. Deterministic.
LoopVerification verify_loop(const Map& map, KeyframeId query, KeyframeId candidate,
                             const DescriptorTraits& traits,
                             const LoopVerificationOptions& options);

}  // namespace dxslam
