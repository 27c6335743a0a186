// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "evaluation/loop_curve.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"

namespace dxslam {
namespace {

void finish(LoopCurve& curve) {
  curve.confidence_at_100_precision = std::numeric_limits<double>::infinity();
  double reached = curve.queries_with_loop > 0 ? 0.0 : std::nan("");
  curve.recall_at_100_precision = reached;
  curve.average_precision = reached;
  for (const PrecisionRecall& point : curve.points) {
    curve.average_precision += point.precision * (point.recall - reached);
    reached = point.recall;
    if (point.wrong > 0) continue;
    curve.recall_at_100_precision = point.recall;
    curve.confidence_at_100_precision = point.confidence;
  }
}

}  // namespace

LoopCurve evaluate_loops(std::vector<LoopGuess> guesses, const LoopTruth& truth,
                         std::size_t queries_with_loop) {
  std::sort(guesses.begin(), guesses.end(),
            [](const LoopGuess& a, const LoopGuess& b) { return a.confidence > b.confidence; });
  LoopCurve curve;
  curve.queries_with_loop = queries_with_loop;
  PrecisionRecall point;
  for (std::size_t i = 0; i < guesses.size(); ++i) {
    require(std::isfinite(guesses[i].confidence), "the confidence of a guess must be finite");
    const PairTruth pair = truth.at(guesses[i].query, guesses[i].match);
    point.right += pair == PairTruth::kSame ? 1 : 0;
    point.wrong += pair == PairTruth::kDifferent ? 1 : 0;
    require(point.right <= queries_with_loop, "more right guesses than queries with a loop");
    const bool last_of_its_kind =
        i + 1 == guesses.size() || guesses[i + 1].confidence < guesses[i].confidence;
    const std::size_t judged = point.right + point.wrong;
    if (!last_of_its_kind || judged == 0) continue;
    point.confidence = guesses[i].confidence;
    point.precision = static_cast<double>(point.right) / static_cast<double>(judged);
    // 0 / 0 where there is no true loop.
    point.recall = static_cast<double>(point.right) / static_cast<double>(queries_with_loop);
    curve.points.push_back(point);
  }
  finish(curve);
  return curve;
}

std::size_t count_queries_with_loop(const LoopTruth& truth, const std::vector<std::size_t>& queries,
                                    const std::vector<std::size_t>& references) {
  const auto has_loop = [&](std::size_t query) {
    return std::any_of(references.begin(), references.end(), [&](std::size_t reference) {
      return reference < query && truth.at(query, reference) == PairTruth::kSame;
    });
  };
  return static_cast<std::size_t>(std::count_if(queries.begin(), queries.end(), has_loop));
}

}  // namespace dxslam
