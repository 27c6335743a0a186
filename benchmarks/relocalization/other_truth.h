// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <memory>
#include <string>

#include "core/sequence.h"

namespace dxslam::benchmark {

/// The same recording with the true poses of `file` (TUM format, stamps of the frames) instead of
/// its own. Throws InputError if a frame has no pose there.
std::unique_ptr<RgbdSequence> with_truth(std::unique_ptr<RgbdSequence> sequence,
                                         const std::string& file);

}  // namespace dxslam::benchmark
