// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <memory>
#include <string>

#include "io/recordings/sequence_reader.h"

namespace dxslam::apps {

/// open_sequence(), which then says on stderr what it guessed, chose or left out
/// (RecordingFacts::notes), one line each.
std::unique_ptr<RgbdSequence> open_recording(const std::string& path,
                                             const SequenceOptions& options = {});

}  // namespace dxslam::apps
