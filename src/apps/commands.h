// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <CLI/CLI.hpp>

namespace dxslam::apps {

/// Exit codes of the program, as docs/commands.md lists them.
enum ExitCode : int {
  kSuccess = 0,
  kBadUsage = 2,        ///< unknown command or option
  kBadInput = 3,        ///< a file, recording, model or configuration that cannot be used
  kTrackingFailed = 4,  ///< the run went through, but no or almost no frame was tracked
  kInterrupted = 5,     ///< stopped by a signal; what was made until then was saved
  kInternalError = 70,
};

/// Of the frames with a pose, for kSuccess.
constexpr double kLeastTrackedShare = 0.1;

// Each adds one subcommand whose callback does the work; failures are thrown
// (InputError, ContractError), main turns them into one line on stderr and an exit code. A command
// that ends with a code of its own throws CLI::RuntimeError(code).
void add_run_command(CLI::App& app);
void add_info_command(CLI::App& app);
void add_record_command(CLI::App& app);
void add_eval_command(CLI::App& app);
void add_synth_command(CLI::App& app);
void add_config_command(CLI::App& app);
void add_features_command(CLI::App& app);
void add_vocab_command(CLI::App& app);
void add_loops_command(CLI::App& app);
void add_map_command(CLI::App& app);
void add_relocalize_command(CLI::App& app);
void add_lifelong_command(CLI::App& app);

}  // namespace dxslam::apps
