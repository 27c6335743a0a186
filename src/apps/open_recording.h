// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "core/image_source.h"
#include "io/recordings/sequence_reader.h"

namespace dxslam::apps {

/// open_sequence(), which then says on stderr what it guessed, chose or left out
/// (RecordingFacts::notes), one line each.
std::unique_ptr<RgbdSequence> open_recording(const std::string& path,
                                             const SequenceOptions& options = {});

/// A camera, or a recording as open_recording() opens it, read so that a stop (process.h) ends it.
std::unique_ptr<ImageSource> open_images(const std::string& source, const SequenceOptions& options,
                                         const ImageSelection& selection);

/// Help for an argument that is a recording, or a recording or a camera: which ones are known.
std::string recording_help();
std::string source_help();

/// Adds the options that say what the recording is: --format, --calibration, --color-topic and
/// --depth-topic.
void add_reader_options(CLI::App& command, SequenceOptions& options);

}  // namespace dxslam::apps
