// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstdint>
#include <vector>

#include "core/camera.h"
#include "core/features.h"
#include "core/se3.h"
#include "geometry/pnp.h"
#include "map/map.h"
#include "optimization/pose_optimizer.h"

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

struct LoopVerificationOptions {
  int group_keyframes = 8;
  int group_min_shared = 15;
  int max_points = 6000;
  int max_shared = 15;
  double ratio = 0.9;
  int min_matches = 15;
  double search_radius = 10.0;
  double search_ratio = 0.95;
  int min_inliers = 30;
  double min_inlier_ratio = 0.25;
  double min_found_share = 0.06;
  int min_cells = 8;
  double min_covered_share = 0.7;
  double depth_tolerance = 0.1;
  double min_depth_share = 0.6;
  int confirming_keyframes = 5;
  int min_confirmations = 3;
  PnpOptions pnp{1000, 0.999, 4.0, 12, 1};
  PoseOptimizerOptions pose;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit("group_keyframes", self.group_keyframes, {1, 1000}, "keyframes",
          "around the candidate whose points are sought in the query");
    visit("group_min_shared", self.group_min_shared, {1, 100000}, "points",
          "that each of them shares with the candidate");
    visit("max_points", self.max_points, {100, 1000000}, "points", "most points sought");
    visit("max_shared", self.max_shared, {1, 100000}, "points",
          "keyframes that share so many are no loop but neighbours");
    visit("ratio", self.ratio, {0.1, 1}, "", "nearest to second nearest descriptor distance");
    visit("min_matches", self.min_matches, {4, 100000}, "matches",
          "of descriptors, before a pose is sought");
    visit("search_radius", self.search_radius, {0.5, 500}, "pixels at 640 wide",
          "window around the pixel of a point, halved in the second round");
    visit("search_ratio", self.search_ratio, {0.1, 1}, "",
          "nearest to second nearest descriptor distance within the window");
    visit("min_inliers", self.min_inliers, {6, 100000}, "points",
          "that must lie where the pose puts them");
    visit("min_inlier_ratio", self.min_inlier_ratio, {0, 1}, "",
          "their share of the matches within the window");
    visit(
        "min_found_share", self.min_found_share, {0, 1}, "",
        "their share of the points that should be in view, or of the keypoints if these are fewer");
    visit("min_cells", self.min_cells, {1, 48}, "cells",
          "of a grid of 8 by 6 over the image in which they must lie");
    visit("min_covered_share", self.min_covered_share, {0, 1}, "",
          "share of the cells where points are due that must hold one: a picture that hangs "
          "elsewhere, too, fills its frame only");
    visit("depth_tolerance", self.depth_tolerance, {0.001, 10}, "",
          "relative difference of predicted and measured depth");
    visit("min_depth_share", self.min_depth_share, {0, 1}, "",
          "share of points at their pixel whose depth must agree");
    visit("confirming_keyframes", self.confirming_keyframes, {0, 100}, "keyframes",
          "neighbours of the query that are asked as well");
    visit("min_confirmations", self.min_confirmations, {0, 100}, "keyframes",
          "neighbours that must see the place, or all where fewer look at it");
    visit.group("pnp", self.pnp);
    visit.group("pose", self.pose);
  }
  template <class Checker>
  void relate(const Checker& check) const {
    check.at_most("min_confirmations", min_confirmations, "confirming_keyframes",
                  confirming_keyframes);
  }
};

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
