// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <vector>

#include "map/map.h"
#include "place/global_index.h"

namespace dxslam {

/// Keyframes that show one part of the scene (paper III.D: the group that a frame is matched
/// against at once).
struct CandidateGroup {
  std::vector<KeyframeId> keyframes;  ///< most similar first, of one component
  std::uint32_t component = 0;
  double promise = 0.0;  ///< by which groups are tried: sum of the three best similarities
};

/// Groups of the `candidates` (best first; those no longer in the map are passed over): the best
/// one left and those that share at least `min_shared` points with it. Groups with less than `size`
/// members are filled up with the best covisible keyframes of their first; of larger ones the
/// best `size` stay, and the others are in no group. By falling promise.
std::vector<CandidateGroup> group_by_covisibility(const Map& map,
                                                  const std::vector<GlobalMatch>& candidates,
                                                  int min_shared, std::size_t size);

}  // namespace dxslam
