// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <CLI/CLI.hpp>

namespace dxslam::apps {

/// Adds `openloris` to the subcommands of `dxslam eval`.
void add_eval_openloris_command(CLI::App& eval);

}  // namespace dxslam::apps
