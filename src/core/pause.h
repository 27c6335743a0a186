// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <functional>

namespace dxslam {

/// Called by long work between pieces of a few milliseconds, in its own thread, so that it can be
/// made to wait for what is more urgent. Empty: never waits.
using Pause = std::function<void()>;

}  // namespace dxslam
