// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

namespace dxslam {

/// From a map of scores to keypoints (paper III.B): threshold, non-maximum suppression and the
/// choice of the best N spread over the image. The `detector` block of a model manifest.
struct DetectorOptions {
  int max_keypoints = 1000;
  double score_threshold = 0.005;
  int nms_radius = 4;
  int nms_iterations = 1;
  int border = 8;
  double spread = 0.0;
  int spread_cell = 40;
  bool sigmoid = false;
  bool subpixel = true;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit("max_keypoints", self.max_keypoints, {1, 20000}, "keypoints", "most keypoints per image");
    visit("score_threshold", self.score_threshold, {0, 1}, "", "lowest score of a keypoint");
    visit("nms_radius", self.nms_radius, {0, 64}, "pixels",
          "half side of the square in which a keypoint must have the highest score");
    visit("nms_iterations", self.nms_iterations, {0, 64}, "passes",
          "further passes that find maxima among what the earlier ones left unsuppressed");
    visit("border", self.border, {0, 256}, "pixels", "margin of the image without keypoints");
    visit(
        "spread", self.spread, {0, 1}, "",
        "share of the keypoints given out evenly to the cells of a grid, the rest by score alone");
    visit("spread_cell", self.spread_cell, {8, 1024}, "pixels", "side of a cell of that grid");
    visit("sigmoid", self.sigmoid, "", "a full-resolution score map holds logits, not scores");
    visit("subpixel", self.subpixel, "", "refine positions by a parabola through the log scores");
  }
};

}  // namespace dxslam
