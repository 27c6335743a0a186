// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <vector>

#include "loop_closing/loop_edge.h"
#include "map/map.h"
#include "optimization/pose_graph.h"

namespace dxslam {

/// What holds a component together, with the ids its numbers belong to: the spanning tree, strong
/// covisibility and the loops closed so far. All edges are measured in the map as it is, so that
/// without a new loop nothing pulls.
struct EssentialGraph {
  PoseGraph graph;                    ///< the component's first keyframe is fixed
  std::vector<KeyframeId> keyframes;  ///< one per node, rising
  /// Node of a keyframe of the component; throws ContractError for others.
  int node_of(KeyframeId id) const;
};

struct EdgeWeights {
  double translation_sigma = 0.05;  ///< metres
  double rotation_sigma = 0.5;      ///< degrees
  double loop_factor = 1000.0;      ///< information of a loop's edge over that of others
};

/// Information of an edge that follows from the two sigmas; scale has that of the rotation.
Matrix7d edge_information(const EdgeWeights& weights);

EssentialGraph make_essential_graph(const Map& map, std::uint32_t component, int min_shared,
                                    const std::vector<LoopEdge>& loops, const EdgeWeights& weights);

/// Length of the shortest way from node `a` to node `b` along edges, metres; infinite if there is
/// none.
double path_length(const EssentialGraph& essential, int a, int b);

}  // namespace dxslam
