// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <memory>

#include "core/sequence.h"

namespace dxslam::apps {

/// The same recording, read so that a stop (process.h) never waits for an image, however long it
/// takes to be read or decoded: read() then returns nothing at once, and skipped() does not count
/// the image. After the stop no further image is read.
std::unique_ptr<RgbdSequence> stoppable(std::unique_ptr<RgbdSequence> recording);

}  // namespace dxslam::apps
