// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include "core/features.h"
#include "core/options.h"

namespace dxslam {

struct TwoViewOptions {
  double max_error = 3.0;
  double ratio = 0.95;
  int iterations = 500;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit("max_error", self.max_error, {0.1, 100}, "pixels",
          "farthest from its epipolar line that a match agrees with the motion");
    visit("ratio", self.ratio, {0.1, 1}, "",
          "largest distance of a match as a share of the second nearest; 1 = any");
    visit("iterations", self.iterations, {10, 100000}, "samples", "most samples of RANSAC");
  }
};

/// Number of mutual nearest neighbours of two images that agree on one epipolar geometry
/// (fundamental matrix by RANSAC, always with the same seed); 0 where fewer than 8 match at all.
/// Needs neither depth nor calibration. Both images have features of one extractor.
int count_epipolar_inliers(const Features& a, const Features& b, const DescriptorTraits& traits,
                           const TwoViewOptions& options = {});

}  // namespace dxslam
