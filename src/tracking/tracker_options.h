// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include "core/options.h"
#include "geometry/pnp.h"
#include "optimization/pose_optimizer.h"
#include "tracking/recovery.h"

namespace dxslam {

/// When a frame becomes a keyframe.
struct KeyframeOptions {
  int max_gap = 30;
  double min_tracked_ratio = 0.85;
  double max_rotation = 10.0;
  double max_translation = 0.1;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit(for_users("max_gap"), self.max_gap, {1, 100000}, "frames",
          "after so many frames any motion makes a keyframe");
    visit("min_tracked_ratio", self.min_tracked_ratio, {0, 1}, "",
          "share of the most points tracked since the last keyframe below which one is due");
    visit(for_users("max_rotation"), self.max_rotation, {0.1, 180}, "degrees",
          "turn against the reference keyframe that makes a keyframe due");
    visit(for_users("max_translation"), self.max_translation, {0.001, 10}, "",
          "move against the reference keyframe, relative to the median depth");
  }
};

struct TrackerOptions {
  int min_start_points = 50;
  int min_inliers = 12;
  double search_radius = 12.0;
  double narrow_radius = 6.0;
  double local_radius = 5.0;
  double ratio = 0.9;
  int min_predicted_matches = 80;
  double agreement_radius = 3.0;
  double good_agreement = 0.4;
  double fair_agreement = 0.3;
  double weak_agreement = 0.2;
  int quick_keypoints = 500;
  int min_quick_inliers = 60;
  double max_view_angle = 70.0;
  double max_distance_ratio = 3.0;
  double depth_tolerance = 0.2;
  int temporary_points_below = 60;
  RecoveryOptions recovery;
  KeyframeOptions keyframe;
  PoseOptimizerOptions pose;
  PnpOptions pnp;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit(for_users("min_start_points"), self.min_start_points, {10, 100000}, "points",
          "keypoints with depth that the first frame needs");
    visit("min_inliers", self.min_inliers, {6, 1000}, "points", "fewer mean that tracking is lost");
    visit("search_radius", self.search_radius, {1, 500}, "pixels at 640 wide",
          "window around the pixel predicted by constant velocity");
    visit("narrow_radius", self.narrow_radius, {0.5, 500}, "pixels at 640 wide",
          "window of the second search, where few matches of the first agree");
    visit("local_radius", self.local_radius, {0.5, 500}, "pixels at 640 wide",
          "window around the pixel of a local map point");
    visit("ratio", self.ratio, {0.1, 1}, "", "nearest to second nearest descriptor distance");
    visit("min_predicted_matches", self.min_predicted_matches, {6, 100000}, "matches",
          "with fewer the whole frame is matched by descriptors alone");
    visit("agreement_radius", self.agreement_radius, {0.1, 100}, "pixels at 640 wide",
          "predicted matches so near to where the pose found puts their points agree with it");
    visit("good_agreement", self.good_agreement, {0, 1}, "",
          "share of the last frame's points in view that must agree for a prediction to be right");
    visit("fair_agreement", self.fair_agreement, {0, 1}, "",
          "the same after a narrow search from the pose found");
    visit("weak_agreement", self.weak_agreement, {0, 1}, "",
          "the same if descriptors found the pose first; with fewer there is no narrow search");
    visit("quick_keypoints", self.quick_keypoints, {10, 100000}, "keypoints",
          "the strongest of both frames, which are tried before all of them");
    visit("min_quick_inliers", self.min_quick_inliers, {6, 100000}, "points",
          "with fewer all keypoints are matched");
    visit("max_view_angle", self.max_view_angle, {1, 180}, "degrees",
          "angle to the mean direction from which a point was seen");
    visit("max_distance_ratio", self.max_distance_ratio, {1, 100}, "",
          "how much nearer or farther than before a point may be seen");
    visit("depth_tolerance", self.depth_tolerance, {0.001, 10}, "",
          "relative difference of predicted and measured depth");
    visit("temporary_points_below", self.temporary_points_below, {0, 100000}, "points",
          "with fewer map points the last frame's depth helps out");
    visit.group("recovery", self.recovery);
    visit.group("keyframe", self.keyframe);
    visit.group("pose", self.pose);
    visit.group("pnp", self.pnp);
  }
  template <class Checker>
  void relate(const Checker& check) const {
    check.at_most("narrow_radius", narrow_radius, "search_radius", search_radius);
    check.at_most("weak_agreement", weak_agreement, "fair_agreement", fair_agreement);
    check.at_most("fair_agreement", fair_agreement, "good_agreement", good_agreement);
    check.at_most("min_quick_inliers", min_quick_inliers, "quick_keypoints", quick_keypoints);
  }
};

}  // namespace dxslam
