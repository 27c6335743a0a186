// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <memory>
#include <string>

#include "core/image_source.h"
#include "io/recordings/sequence_reader.h"

namespace dxslam {

/// Whether `name` is that of a camera: "KIND:" and so on, of a kind that is known here.
bool is_live_source(const std::string& name);
/// What names a camera, for help and messages; one line.
std::string known_live_sources();

/// Opens a camera and waits for its first image (live_source.h). Of `options`, `calibration` and
/// `max_association_s` have a meaning. Throws InputError for a camera that cannot be used, and for
/// other options.
std::unique_ptr<ImageSource> open_live_source(const std::string& name,
                                              const SequenceOptions& options = {},
                                              const ImageSelection& selection = {});

/// A camera, or every recording that open_sequence() reads.
std::unique_ptr<ImageSource> open_source(const std::string& name,
                                         const SequenceOptions& options = {},
                                         const ImageSelection& selection = {});

}  // namespace dxslam
