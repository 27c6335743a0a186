// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include "core/options.h"
#include "geometry/pnp.h"
#include "map/local_map.h"
#include "optimization/pose_optimizer.h"

namespace dxslam {

/// What a pose must show to be believed (docs/relocalization.md has the calibration).
struct AcceptanceOptions {
  int min_matched = 13;
  int min_inliers = 22;
  double min_ratio = 0.015;
  double min_coverage = 0.55;
  double min_spread = 0.03;
  double min_confidence = 0.95;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit("min_matched", self.min_matched, {4, 100000}, "points",
          "matches by descriptor alone that agree with the pose");
    visit("min_inliers", self.min_inliers, {6, 100000}, "points",
          "map points that agree with the refined pose");
    visit("min_ratio", self.min_ratio, {0, 1}, "",
          "share of them among the map points that should be in view");
    visit("min_coverage", self.min_coverage, {0, 1}, "",
          "share of the parts of the image, with keypoints and map points, where some agree");
    visit("min_spread", self.min_spread, {0, 1}, "",
          "their deviation along the narrowest direction, relative to the image's diagonal");
    visit(for_users("min_confidence"), self.min_confidence, {0, 1}, "",
          "probability of being right, by the calibration");
  }
};

/// When weak poses of frames in a row are believed together.
struct ConsensusOptions {
  int frames = 3;
  int min_matched = 10;
  int min_inliers = 15;
  double min_coverage = 0.55;
  double max_gap = 1.0;
  double max_speed = 1.5;
  double max_turn = 120.0;
  double distance_slack = 0.1;
  double angle_slack = 5.0;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit("frames", self.frames, {2, 100}, "frames", "weak poses in a row that have to agree");
    visit("min_matched", self.min_matched, {4, 100000}, "points",
          "of a weak pose: matches by descriptor alone that agree with it");
    visit("min_inliers", self.min_inliers, {6, 100000}, "points",
          "of a weak pose: map points that agree with it");
    visit("min_coverage", self.min_coverage, {0, 1}, "", "of a weak pose, as for acceptance");
    visit("max_gap", self.max_gap, {0.001, 60}, "s", "longest time between two of them");
    visit(for_users("max_speed"), self.max_speed, {0, 100}, "m/s", "how fast the camera may move");
    visit(for_users("max_turn"), self.max_turn, {0, 3600}, "degrees/s", "how fast it may turn");
    visit("distance_slack", self.distance_slack, {0, 10}, "m", "error of a weak pose");
    visit("angle_slack", self.angle_slack, {0, 180}, "degrees", "the same of its direction");
  }
};

struct RelocalizationOptions {
  int candidates = 20;
  int max_groups = 3;
  int group_keyframes = 6;
  int min_shared = 20;
  int max_keypoints = 700;
  int max_group_rows = 2500;
  int descriptors_per_point = 2;
  double match_ratio = 0.95;
  int min_matches = 15;
  double wide_radius = 10.0;
  double narrow_radius = 5.0;
  double max_view_angle = 75.0;
  double max_distance_ratio = 3.0;
  double depth_tolerance = 0.15;
  LocalMapOptions local_map{15, 10, 1.0, 45.0, 4000};
  PnpOptions pnp{600, 0.999, 5.0, 8, 1};
  PoseOptimizerOptions pose;
  AcceptanceOptions acceptance;
  ConsensusOptions consensus;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit("candidates", self.candidates, {1, 10000}, "keyframes",
          "keyframes retrieved by global descriptor");
    visit("max_groups", self.max_groups, {1, 1000}, "groups", "most groups tried");
    visit("group_keyframes", self.group_keyframes, {1, 100}, "keyframes", "size of a group");
    visit("min_shared", self.min_shared, {1, 10000}, "points",
          "points that keyframes of one group share with its best");
    visit("max_keypoints", self.max_keypoints, {10, 100000}, "keypoints",
          "keypoints of the frame that are matched without a pose");
    visit("max_group_rows", self.max_group_rows, {10, 1000000}, "descriptors",
          "most descriptors of a group");
    visit("descriptors_per_point", self.descriptors_per_point, {1, 100}, "descriptors",
          "most descriptors of a point of a group");
    visit("match_ratio", self.match_ratio, {0.1, 1}, "",
          "nearest to second nearest descriptor distance, of different points");
    visit("min_matches", self.min_matches, {6, 100000}, "matches",
          "a group with fewer is given up");
    visit("wide_radius", self.wide_radius, {1, 500}, "pixels at 640 wide",
          "window around the projection of a map point, at first");
    visit("narrow_radius", self.narrow_radius, {0.5, 500}, "pixels at 640 wide",
          "the same for the final pose");
    visit("max_view_angle", self.max_view_angle, {1, 180}, "degrees",
          "angle to the mean direction from which a point was seen");
    visit("max_distance_ratio", self.max_distance_ratio, {1, 100}, "",
          "how much nearer or farther than before a point may be seen");
    visit("depth_tolerance", self.depth_tolerance, {0.001, 10}, "",
          "relative difference of predicted and measured depth");
    visit.group("local_map", self.local_map);
    visit.group("pnp", self.pnp);
    visit.group("pose", self.pose);
    visit.group("acceptance", self.acceptance);
    visit.group("consensus", self.consensus);
  }
  template <class Checker>
  void relate(const Checker& check) const {
    check.at_most("narrow_radius", narrow_radius, "wide_radius", wide_radius);
    // What is weak alone needs less than what is believed alone.
    check.at_most("consensus.min_matched", consensus.min_matched, "acceptance.min_matched",
                  acceptance.min_matched);
    check.at_most("consensus.min_inliers", consensus.min_inliers, "acceptance.min_inliers",
                  acceptance.min_inliers);
    check.at_most("consensus.min_coverage", consensus.min_coverage, "acceptance.min_coverage",
                  acceptance.min_coverage);
  }
};

}  // namespace dxslam
