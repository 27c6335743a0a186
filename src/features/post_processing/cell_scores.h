// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <vector>

#include "features/network/tensor_view.h"

namespace dxslam {

/// Turns a SuperPoint-style detector head (paper III.B) into a map of scores: each cell of
/// cell x cell pixels has one logit per pixel (channel = row in cell * cell + column in cell) and,
/// last, one for "no keypoint here"; a softmax over them gives the probabilities. Their logarithms
/// are kept, which cost nothing more and are what sub-pixel refinement wants. Keeps its buffer
/// between images; one thread at a time.
class CellScores {
 public:
  explicit CellScores(int cell) : cell_(cell) {}

  /// Log probabilities at full resolution, one channel; valid until the next call. `logits` has
  /// cell * cell + 1 channels side by side (channel_stride 1) and no gaps.
  TensorView log_probabilities(const TensorView& logits);

 private:
  int cell_;
  std::vector<float> map_;
  std::vector<float> normalizers_;  // of a row of cells
};

}  // namespace dxslam
