// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace dxslam {

/// Whether two frames show the same place.
enum class PairTruth {
  kDifferent,
  kSame,
  kUnclear,  ///< neither a right nor a wrong match
};

/// True loops of one recording: a statement on each pair of frames, the same in both orders.
class LoopTruth {
 public:
  /// All pairs are different. Takes frames^2 / 16 bytes, as much again once a pair is unclear.
  explicit LoopTruth(std::size_t frames);

  std::size_t frames() const { return frames_; }
  /// Throws ContractError for an index beyond frames(), or equal ones.
  PairTruth at(std::size_t a, std::size_t b) const;
  void set(std::size_t a, std::size_t b, PairTruth truth);

 private:
  std::size_t cell(std::size_t a, std::size_t b) const;

  std::size_t frames_;
  std::vector<bool> same_;     // below the diagonal, row by row
  std::vector<bool> unclear_;  // likewise; empty while no pair is
};

/// Reads a matrix of true loops: element (i, j) or (j, i) other than zero says that frames i and j
/// show the same place; the diagonal says nothing. By content a MATLAB v5 file, an image (PNG or
/// JPEG; grey 128 and above is a loop) or text, one row per line. Throws InputError, one sentence
/// with the file, unless it is square and has at least one loop.
LoopTruth read_loop_truth(const std::string& path);

/// The truth of every `step`-th frame from `first` on: of one camera where a matrix is of images
/// that come from several in turn (New College: step 2). Throws ContractError for step 0.
LoopTruth every_nth(const LoopTruth& truth, std::size_t first, std::size_t step);

}  // namespace dxslam
