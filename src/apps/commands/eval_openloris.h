// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <CLI/CLI.hpp>

#include "io/primitives/output_file.h"

namespace dxslam::apps {

/// Adds `openloris` to the subcommands of `dxslam eval`.
/// The JSON files of all `dxslam eval` commands.
FileKind report_kind();

void add_eval_openloris_command(CLI::App& eval);

}  // namespace dxslam::apps
