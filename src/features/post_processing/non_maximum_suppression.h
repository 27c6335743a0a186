// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <vector>

#include "features/post_processing/candidate.h"

namespace dxslam {

/// Non-maximum suppression in squares of side 2 * radius + 1 (paper III.B), with the result of
/// the usual dense form: find all local maxima, remove them and what lies in their squares, find
/// the maxima of the rest, `iterations` times. Of equal scores the first in raster order counts as
/// the higher. Only candidates are visited, so the cost follows their number, not the image's
/// size. Keeps its buffers between images; one thread at a time.
class NonMaximumSuppression {
 public:
  /// Reduces `candidates` (distinct pixels inside width x height) to the maxima, in the order they
  /// were found: pass by pass, within a pass as given.
  void run(int width, int height, int radius, int iterations, std::vector<Candidate>& candidates);

 private:
  bool is_maximum(const Candidate& candidate, int radius) const;
  float* pixel(int x, int y) { return map_.data() + (y + margin_) * stride_ + (x + margin_); }
  const float* pixel(int x, int y) const {
    return map_.data() + (y + margin_) * stride_ + (x + margin_);
  }
  void resize(int width, int height, int radius);

  std::vector<float> map_;  // scores with a margin; the lowest float where there is no candidate
  std::ptrdiff_t stride_ = 0;
  int width_ = 0;
  int height_ = 0;
  int margin_ = 0;
  std::vector<Candidate> maxima_;
  std::vector<Candidate> rest_;
};

}  // namespace dxslam
