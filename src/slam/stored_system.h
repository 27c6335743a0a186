// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <string>
#include <vector>

#include "features/extractor.h"
#include "loop_closing/loop_edge.h"
#include "map_files/map_file.h"
#include "slam/system.h"

namespace dxslam {

/// What a map made now with these features is made with.
MapHeader map_header(const FeatureExtractor& extractor);

/// The loops of a map as its file holds them, and back.
std::vector<StoredLoopEdge> stored_loops(const Map& map, const std::vector<LoopEdge>& loops);
std::vector<LoopEdge> loop_edges(const std::vector<StoredLoopEdge>& stored);

/// Hands a map, read from the file `path`, to the system, which has not had an image yet. Throws
/// InputError if it was made with other features than `current`. Returns the pictures in it, one
/// for each of its keyframes' ids; empty strings where there is none.
std::vector<std::string> hand_over(StoredMap stored, System& system, const std::string& path,
                                   const MapHeader& current);

/// Throws InputError if it cannot be saved, and ContractError for an empty map. `thumbnails` are as
/// in take_snapshot().
void save_system_map(const std::string& path, const MapHeader& header, const Map& map,
                     const std::vector<LoopEdge>& loops,
                     const std::vector<std::string>& thumbnails = {});

}  // namespace dxslam
