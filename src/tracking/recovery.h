// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include "core/options.h"
#include "core/se3.h"

namespace dxslam {

/// When a pose is believed that descriptors found without a prediction.
struct RecoveryOptions {
  double min_coverage = 0.25;
  double lost_coverage = 0.5;
  double far_coverage = 0.55;
  int far_inliers = 50;
  double max_speed = 1.5;
  double max_turn = 120.0;
  double distance_slack = 0.1;
  double angle_slack = 5.0;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit("min_coverage", self.min_coverage, {0, 1}, "",
          "share of the parts of the image, with keypoints and map points, where some must agree, "
          "right after a frame with a pose");
    visit("lost_coverage", self.lost_coverage, {0, 1}, "", "the same after frames without one");
    visit("far_coverage", self.far_coverage, {0, 1}, "",
          "the same of a pose where the camera can hardly be by now");
    visit("far_inliers", self.far_inliers, {6, 100000}, "points",
          "that must agree with such a pose");
    visit(for_users("max_speed"), self.max_speed, {0, 1000}, "m/s", "how fast the camera may move");
    visit(for_users("max_turn"), self.max_turn, {0, 36000}, "degrees/s", "how fast it may turn");
    visit("distance_slack", self.distance_slack, {0, 10}, "m", "error of a pose found so");
    visit("angle_slack", self.angle_slack, {0, 180}, "degrees", "the same of its direction");
  }
  template <class Checker>
  void relate(const Checker& check) const {
    check.at_most("min_coverage", min_coverage, "lost_coverage", lost_coverage);
    check.at_most("lost_coverage", lost_coverage, "far_coverage", far_coverage);
  }
};

/// From the last frame with a pose to this one.
struct RecoveryStep {
  SE3 last_from_camera;
  double seconds = 0.0;       ///< not above zero where a clock jumped back
  bool was_tracking = false;  ///< no frame without a pose lies between
};

/// Wallpaper, doors and posters are there twice: enough of their points fit a wrong pose perfectly.
/// What tells is how much of the image agrees (`coverage`, see agreeing_share()), and whether the
/// camera can be there. What is refused here is left to relocalization, which has the whole map.
bool is_believable_recovery(const RecoveryOptions& options, double coverage, int inliers,
                            const RecoveryStep& step);

}  // namespace dxslam
