// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "io/recordings/sequence_reader.h"

namespace dxslam::apps {

/// open_sequence(), which then says on stderr what it guessed, chose or left out
/// (RecordingFacts::notes), one line each.
std::unique_ptr<RgbdSequence> open_recording(const std::string& path,
                                             const SequenceOptions& options = {});

/// Help for an argument that is a recording: which ones are known.
std::string recording_help();

/// Adds the options that say what the recording is: --format, --calibration, --color-topic and
/// --depth-topic.
void add_reader_options(CLI::App& command, SequenceOptions& options);

}  // namespace dxslam::apps
