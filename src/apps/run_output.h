// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <string>

#include "apps/run_settings.h"
#include "core/sequence.h"
#include "slam/system.h"

namespace dxslam::apps {

/// Writes trajectory.txt, keyframes.txt, map.ply, trajectory.svg and summary.json into the folder,
/// each atomically. The poses as they were known while running move to trajectory_online.txt.
void write_results(const std::string& folder, const RunSettings& settings, const RunRecord& record,
                   const SystemOptions& options, const RgbdSequence& sequence,
                   const System& system);

/// Frames tracked.
std::size_t tracked_frames(const System& system);

}  // namespace dxslam::apps
