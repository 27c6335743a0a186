// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <vector>

#include "core/sim3.h"
#include "optimization/may_go_on.h"

namespace dxslam {

/// Poses with scale and what is known between pairs of them: the essential graph of a map.
struct PoseGraph {
  struct Node {
    Sim3 world_from_node;
    bool fixed = false;
  };
  struct Edge {
    int a = 0;  ///< indices into nodes, not the same
    int b = 0;
    Sim3 a_from_b;  ///< measured
    /// Inverse covariance of (rho, phi, sigma) of the error, see optimize_pose_graph; symmetric and
    /// positive definite.
    Matrix7d information = Matrix7d::Identity();
  };
  std::vector<Node> nodes;
  std::vector<Edge> edges;
};

struct PoseGraphOptions {
  int iterations = 20;
  bool with_scale = false;  // RGB-D maps do not drift in scale
  double huber = 0.0;       // 0: no kernel

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit("iterations", self.iterations, {1, 1000}, "steps", "most steps");
    visit("with_scale", self.with_scale, "", "whether nodes may change their scale");
    visit("huber", self.huber, {0, 1000}, "sigma", "width of the kernel of an edge, 0 for none");
  }
};

struct PoseGraphReport {
  bool usable = false;     ///< the graph was changed to a finite state of no higher cost
  bool cancelled = false;  ///< it might not go on; the graph is then unchanged
  int iterations = 0;
  double initial_cost = 0.0;  ///< half the sum of squared errors in sigma, under the kernel
  double final_cost = 0.0;
};

/// Spreads the contradictions of loops over the whole graph: minimises the sum over edges of
/// log(a_from_b^-1 * world_from_a^-1 * world_from_b), weighted by information, over all nodes not
/// fixed. If none is, node 0 is held. Nodes without edges stay as they are. Changes the nodes in
/// place only on success. Throws ContractError on indices out of range, edges from a node to
/// itself, and information that is not positive definite.
PoseGraphReport optimize_pose_graph(PoseGraph& graph, const PoseGraphOptions& options,
                                    const MayGoOn& may_go_on = {});

}  // namespace dxslam
