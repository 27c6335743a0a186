// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <optional>
#include <vector>

#include "core/options.h"
#include "core/trajectory.h"
#include "evaluation/loop_truth.h"
#include "evaluation/view_overlap.h"

namespace dxslam {

/// When two frames of a trajectory count as views of the same place.
struct PoseLoopOptions {
  double radius = 0.75;
  double angle = 30.0;
  double window = 3.0;
  double unclear = 2.0;
  double overlap = 0.1;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit("radius", self.radius, {0.01, 1e4}, "m", "farthest distance of two views of one place");
    visit("angle", self.angle, {1, 180}, "degrees", "largest angle between their orientations");
    visit("window", self.window, {0, 1e6}, "s", "least time between them");
    visit("unclear", self.unclear, {1, 100}, "",
          "pairs within so many times radius and angle that are no loop count neither as right nor "
          "as wrong; 1 = none");
    visit("overlap", self.overlap, {0.001, 1}, "",
          "pairs that are no loop but see so much of the same surface count neither as right nor "
          "as wrong (with depth only); 1 = none");
  }
};

/// True loops of frames with these poses (paper IV.D has them from the data set; here from the
/// trajectory). `poses[i]` is that of frame `frames[i]`, rising and below `frame_count`. Pairs
/// closer in time than the window are different; pairs with a frame that has no pose are unclear.
LoopTruth loop_truth_from_poses(const Trajectory& poses, const std::vector<std::size_t>& frames,
                                std::size_t frame_count, const PoseLoopOptions& options);

/// Makes pairs unclear that are different but see the same surface, as from opposite sides of a
/// table: to match them is no mistake. `views[i]` is what frame i saw, nothing where it has no
/// depth or pose.
void mark_overlapping_views(const std::vector<std::optional<DepthView>>& views,
                            const PoseLoopOptions& options, LoopTruth& truth);

}  // namespace dxslam
