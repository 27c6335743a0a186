// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "evaluation/ate.h"

namespace dxslam {

AteReport evaluate_ate(const Trajectory& truth, const Trajectory& estimate,
                       const AteOptions& options) {
  AteReport report;
  report.pairs = associate_or_throw(truth, estimate, options.max_difference);
  report.truth_from_estimate = align(report.pairs, options.alignment);
  for (PosePair& pair : report.pairs) {
    pair.estimate = transformed({pair.estimate}, report.truth_from_estimate).front();
    report.errors.push_back(
        translation_distance(pair.truth.world_from_camera, pair.estimate.world_from_camera));
  }
  report.position = summarise(report.errors);
  return report;
}

}  // namespace dxslam
