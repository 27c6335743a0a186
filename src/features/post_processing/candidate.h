// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

namespace dxslam {

/// A pixel that may become a keypoint.
struct Candidate {
  int x = 0;
  int y = 0;
  float score = 0.0F;  ///< larger is better; of any sign
};

/// Half-open rectangle of pixels.
struct PixelArea {
  int x_begin = 0;
  int y_begin = 0;
  int x_end = 0;
  int y_end = 0;

  bool contains(int x, int y) const {
    return x >= x_begin && x < x_end && y >= y_begin && y < y_end;
  }
};

/// The strict order of candidates, best first: by score, ties in raster order, so that results
/// never depend on the order in which candidates were found.
inline bool better(const Candidate& a, const Candidate& b) {
  if (a.score != b.score) return a.score > b.score;
  if (a.y != b.y) return a.y < b.y;
  return a.x < b.x;
}

}  // namespace dxslam
