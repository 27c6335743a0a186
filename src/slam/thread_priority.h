// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

namespace dxslam {

/// Raises the niceness of the calling thread, and of the threads that it will start, by `steps` (0
/// to 19). Does nothing where threads have no niceness of their own (all but Linux).
void lower_thread_priority(int steps);

}  // namespace dxslam
