// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/options.h"

namespace dxslam {

/// How loops are found, and from when on they are believed. The thresholds marked "calibrated" are
/// those of the shipped network and vocabularies; benchmarks/loops --calibrate measures them
/// anew and writes them here (docs/loops.md).
struct LoopOptions {
  std::string method = "hf-bow-global";
  int candidates = 10;
  double min_relative_score = 0.95;
  double min_score_orb = 0.405;        // calibrated
  double min_score_hf = 0.445;         // calibrated
  double min_score_global = 0.324;     // calibrated
  double max_distance = 1.596;         // calibrated
  double max_distance_paper = 0.871;   // calibrated
  double max_distance_global = 0.871;  // calibrated

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit("method", self.method, "",
          "orb-bow, hf-bow, hf-bow-global, hf-bow-global-paper or global-only");
    visit("candidates", self.candidates, {1, 10000}, "places",
          "most similar places by words whose global descriptors are compared (hf-bow-global...)");
    visit(
        "min_relative_score", self.min_relative_score, {0, 1}, "",
        "of these, relative to the best: places less alike by words are left out (hf-bow-global)");
    visit("min_score_orb", self.min_score_orb, {0, 2}, "", "least score of words (orb-bow)");
    visit("min_score_hf", self.min_score_hf, {0, 2}, "", "least score of words (hf-bow)");
    visit("min_score_global", self.min_score_global, {0, 2}, "",
          "least score of words of the place with the nearest global descriptor (hf-bow-global)");
    visit("max_distance", self.max_distance, {0, 2}, "",
          "farthest global descriptor, L2, whatever the words say (hf-bow-global)");
    visit("max_distance_paper", self.max_distance_paper, {0, 2}, "",
          "farthest global descriptor, L2 (hf-bow-global-paper)");
    visit("max_distance_global", self.max_distance_global, {0, 2}, "",
          "farthest global descriptor, L2 (global-only)");
  }
};

/// The options of a detector by itself, as `dxslam loops` runs it: without a map, whose geometry
/// would decide.
struct LoopDetectorOptions : LoopOptions {
  LoopDetectorOptions() = default;
  LoopDetectorOptions(LoopOptions options)  // NOLINT(google-explicit-constructor)
      : LoopOptions(std::move(options)) {}

  int min_inliers_orb = 42;  // calibrated
  int min_inliers_hf = 30;   // calibrated
  int verified_candidates = 3;
  int consistent_queries = 1;
  int consistent_distance = 10;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    LoopOptions::describe(self, visit);
    visit("min_inliers_orb", self.min_inliers_orb, {8, 10000}, "matches",
          "fewest matches that agree on a motion between the views (orb-bow+geometry)");
    visit("min_inliers_hf", self.min_inliers_hf, {8, 10000}, "matches",
          "the same for the other methods with +geometry");
    visit("verified_candidates", self.verified_candidates, {1, 1000}, "places",
          "best places whose geometry is checked (+geometry)");
    visit("consistent_queries", self.consistent_queries, {1, 100}, "queries",
          "so many queries in a row must find places near each other; 1 = no such condition");
    visit("consistent_distance", self.consistent_distance, {0, 1000000}, "places",
          "places whose ids differ by no more are near each other");
  }
};

/// What a name of a method stands for.
struct LoopMethod {
  bool orb = false;       ///< words of ORB, else of the network's descriptors
  bool words = true;      ///< candidates by words, else by global descriptor
  bool global = false;    ///< the nearest global descriptor wins, else the score of words
  bool agree = false;     ///< both levels must agree on the winner, else only what made it win
  bool geometry = false;  ///< candidates are ranked and accepted by geometry
  std::string name;
};

/// Throws InputError, with the names that there are, for another name.
LoopMethod parse_loop_method(const std::string& name);

/// orb-bow, hf-bow, hf-bow-global, hf-bow-global-paper, global-only; then each with +geometry.
const std::vector<std::string>& loop_method_names();

}  // namespace dxslam
