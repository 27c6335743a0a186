// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <string>

#include "io/recordings/sequence_reader.h"
#include "slam/system_options.h"

namespace dxslam::apps {

/// What `dxslam run` and `dxslam lifelong` are asked for alike.
struct RunSettings {
  SequenceOptions reader;
  std::string config;
  std::string features;
  std::string out;
  std::string mode;        ///< "": as configured
  std::string vocabulary;  ///< "": as configured
  std::string map_in;
  std::string map_out;
  int autosave = 0;         ///< keyframes between two saves of map_out; 0: only at the end
  bool thumbnails = false;  ///< pictures of the keyframes into map_out
  bool no_loop_closing = false;
  std::size_t stride = 1;
  bool deterministic = false;
};

/// Adds the options for them, except --out.
void add_run_options(CLI::App& command, RunSettings& settings);

/// The options of the system as configured, with what the command line says. Throws InputError for
/// what cannot be used, and for settings that do not go together.
SystemOptions system_options_of(const RunSettings& settings);

}  // namespace dxslam::apps
