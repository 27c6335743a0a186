// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include "core/options.h"
#include "geometry/pnp.h"
#include "optimization/bundle_adjustment.h"
#include "optimization/pose_graph.h"
#include "optimization/pose_optimizer.h"

namespace dxslam {

/// When two keyframes are taken for the same place (loop_verification.h).
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

/// How a verified loop may change the map (loop_correction.h).
struct LoopCorrectionOptions {
  double agreed_translation = 0.03;
  double agreed_rotation = 0.5;
  double drift_allowance = 0.5;
  double drift_per_metre = 0.1;
  double turn_allowance = 10.0;
  double turn_per_metre = 1.0;
  int min_shared = 80;
  double translation_sigma = 0.05;
  double rotation_sigma = 0.5;
  double loop_factor = 1000.0;
  double max_loop_translation = 0.05;
  double max_loop_rotation = 1.0;
  double max_bend_translation = 0.05;
  double max_bend_rotation = 2.0;
  int weld_keyframes = 8;
  int weld_min_shared = 15;
  double weld_radius = 8.0;
  double weld_ratio = 0.95;
  double weld_depth_tolerance = 0.1;
  PoseGraphOptions graph{50};

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit("agreed_translation", self.agreed_translation, {0, 10}, "m",
          "a loop that contradicts the map by less moves nothing, but fuses points");
    visit("agreed_rotation", self.agreed_rotation, {0, 180}, "degrees", "the same for rotation");
    visit("drift_allowance", self.drift_allowance, {0, 1000}, "m",
          "drift that a loop may claim whatever the length of the way round");
    visit("drift_per_metre", self.drift_per_metre, {0, 1}, "", "and so much more for each metre");
    visit("turn_allowance", self.turn_allowance, {0, 180}, "degrees",
          "drift in rotation that a loop may claim");
    visit("turn_per_metre", self.turn_per_metre, {0, 180}, "degrees", "and so much more for each");
    visit("min_shared", self.min_shared, {1, 100000}, "points",
          "that covisible keyframes must share to be tied in the pose graph");
    visit("translation_sigma", self.translation_sigma, {1e-6, 100}, "m",
          "standard deviation of an edge of the pose graph");
    visit("rotation_sigma", self.rotation_sigma, {1e-6, 180}, "degrees", "the same for rotation");
    visit("loop_factor", self.loop_factor, {1, 1e9}, "",
          "how much more a loop's edge weighs than others");
    visit("max_loop_translation", self.max_loop_translation, {0, 100}, "m",
          "what may remain of the contradiction");
    visit("max_loop_rotation", self.max_loop_rotation, {0, 180}, "degrees",
          "the same for rotation");
    visit("max_bend_translation", self.max_bend_translation, {0, 100}, "m",
          "by how much any other edge may change, beyond the drift of its length");
    visit("max_bend_rotation", self.max_bend_rotation, {0, 180}, "degrees",
          "the same for rotation");
    visit("weld_keyframes", self.weld_keyframes, {1, 1000}, "keyframes",
          "on either side of the loop whose points are fused");
    visit("weld_min_shared", self.weld_min_shared, {1, 100000}, "points",
          "that each of them shares with the query or the candidate");
    visit("weld_radius", self.weld_radius, {0.5, 100}, "pixels at 640 wide",
          "window around the pixel of a point to fuse");
    visit("weld_ratio", self.weld_ratio, {0.1, 1}, "",
          "nearest to second nearest descriptor distance");
    visit("weld_depth_tolerance", self.weld_depth_tolerance, {0.001, 10}, "",
          "relative difference of predicted and measured depth");
    visit.group("graph", self.graph);
  }
};

/// The whole step, from candidates to the corrected map (loop_closer.h).
struct LoopCloserOptions {
  int max_candidates = 5;
  int pause_keyframes = 5;
  bool full_bundle = true;
  LoopVerificationOptions verification;
  LoopCorrectionOptions correction;
  BundleOptions bundle{10, 10};

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit("max_candidates", self.max_candidates, {1, 1000}, "keyframes",
          "most candidates verified for one keyframe");
    visit("pause_keyframes", self.pause_keyframes, {0, 100000}, "keyframes",
          "that go by after a loop before the next one is looked at");
    visit(for_users("full_bundle"), self.full_bundle, "",
          "adjust all keyframes and points in the background after a correction");
    visit.group("verification", self.verification);
    visit.group("correction", self.correction);
    visit.group("bundle", self.bundle);
  }
};

}  // namespace dxslam
