// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

namespace dxslam::apps {

/// From now on the first SIGINT or SIGTERM only makes stop_requested() true, so that the command
/// can end in order; a second one ends it at once.
void catch_signals();
bool stop_requested();

}  // namespace dxslam::apps
