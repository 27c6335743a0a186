// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <vector>

#include "features/candidate.h"
#include "features/simd_level.h"
#include "features/tensor_view.h"

namespace dxslam {

/// Reads a SuperPoint-style detector head (paper III.B): each cell of cell x cell pixels has one
/// logit a pixel (channel = row in cell * cell + column in cell) and, last, one for "no keypoint
/// here"; a softmax over them gives the scores. Works in the log domain: only pixels above the
/// threshold ever cost more than their part of the softmax. Keeps its buffers between images.
class CellScores {
 public:
  explicit CellScores(int cell) : cell_(cell) {}

  /// Normalises all cells of `logits` (channel_stride 1, cell * cell + 1 channels) and appends to
  /// `candidates` the pixels inside `area` whose probability is above `threshold` > 0; the scores
  /// are log probabilities. `logits` must stay valid for log_score().
  void find(const TensorView& logits, double threshold, const PixelArea& area,
            std::vector<Candidate>& candidates, SimdLevel level = simd_level());

  /// Log probability of any pixel of the last map; the pixel must lie inside it.
  float log_score(int x, int y) const {
    const int row = y / cell_;
    const int column = x / cell_;
    const int channel = (y - row * cell_) * cell_ + (x - column * cell_);
    return logits_.at(row, column)[channel] -
           normalizers_[static_cast<std::size_t>(row) * logits_.width + column];
  }

 private:
  int cell_;
  TensorView logits_;
  std::vector<float> normalizers_;  // log of the sum of exponentials, a cell
  std::vector<float> best_;         // highest logit of a pixel, a cell
};

}  // namespace dxslam
