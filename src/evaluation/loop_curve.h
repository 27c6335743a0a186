// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "evaluation/loop_truth.h"

namespace dxslam {

/// The one earlier frame that a detector takes a query for, were it to accept it.
struct LoopGuess {
  std::size_t query = 0;
  std::size_t match = 0;
  double confidence = 0.0;  ///< larger is surer; any scale
};

/// Precision and recall if all guesses at least this sure are accepted.
struct PrecisionRecall {
  double confidence = 0.0;
  double precision = 0.0;
  double recall = 0.0;
  std::size_t right = 0;
  std::size_t wrong = 0;
};

struct LoopCurve {
  std::vector<PrecisionRecall> points;  ///< by falling confidence, one for each distinct value
  std::size_t queries_with_loop = 0;
  double recall_at_100_precision = 0.0;
  /// Lowest confidence at which no guess is wrong; infinite if the surest guess is.
  double confidence_at_100_precision = 0.0;
  /// Sum over the points of precision times the gain in recall.
  double average_precision = 0.0;
};

/// Judges at most one guess per query. A guess is right if its frames show the same place; one of
/// an unclear pair counts as neither. Recall is the share of `queries_with_loop` (number of queries
/// that have a true loop) with a right guess; where there is none, all that recall is part of is
/// not a number. Throws ContractError for a guess beyond the truth, a confidence that is not
/// finite, or more right guesses than queries with a loop.
LoopCurve evaluate_loops(std::vector<LoopGuess> guesses, const LoopTruth& truth,
                         std::size_t queries_with_loop);

/// Number of frames in `queries` that show the same place as one of `references` before them.
std::size_t count_queries_with_loop(const LoopTruth& truth, const std::vector<std::size_t>& queries,
                                    const std::vector<std::size_t>& references);

struct NamedCurve {
  std::string name;
  LoopCurve curve;
};

/// A self-contained SVG picture of precision over recall, one line per curve, with a legend that
/// names each with its recall at 100 % precision.
std::string draw_loop_curves_svg(const std::vector<NamedCurve>& curves, const std::string& title,
                                 const std::string& subtitle = "");

}  // namespace dxslam
