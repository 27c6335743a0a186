// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <string>
#include <vector>

#include "apps/loop_experiment.h"
#include "apps/output_steps.h"
#include "evaluation/loop_curve.h"
#include "io/primitives/result_folder.h"

namespace dxslam::apps {

/// Precision and recall of each method, in their order.
std::vector<NamedCurve> judge_methods(const LoopExperiment& experiment, const LoopTruth& truth);

/// The files that write_loop_results() writes into a folder.
ResultFiles loop_result_files();

/// Files as docs/file_formats.md has them: candidates.csv, pr.csv, pr.svg and summary.json in
/// `out`, or one such folder per method below it, with pr.svg and summary.json of all. Each is
/// written whatever becomes of the others.
void write_loop_results(OutputSteps& steps, ResultFolder& out, const LoopSettings& settings,
                        const LoopExperiment& experiment, const LoopTruth& truth,
                        const std::vector<NamedCurve>& curves, const std::string& name);

}  // namespace dxslam::apps
