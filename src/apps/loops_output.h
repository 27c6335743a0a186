// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <string>
#include <vector>

#include "apps/loop_experiment.h"
#include "evaluation/loop_curve.h"

namespace dxslam::apps {

/// Precision and recall of each method, in their order.
std::vector<NamedCurve> judge_methods(const LoopExperiment& experiment, const LoopTruth& truth);

/// Files as docs/file_formats.md has them: candidates.csv, pr.csv, pr.svg and summary.json in
/// `settings.out`, or one such folder a method below it, with pr.svg and summary.json of all.
/// Throws InputError if they cannot be written.
void write_loop_results(const LoopSettings& settings, const LoopExperiment& experiment,
                        const LoopTruth& truth, const std::vector<NamedCurve>& curves,
                        const std::string& name);

}  // namespace dxslam::apps
