// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "loop_closing/essential_graph.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <queue>
#include <set>
#include <utility>

#include "core/error.h"

namespace dxslam {
namespace {

class EssentialGraphBuilder {
 public:
  EssentialGraphBuilder(const Map& map, const EdgeWeights& weights)
      : map_(map), information_(edge_information(weights)), loop_factor_(weights.loop_factor) {}

  void add_nodes(std::uint32_t component) {
    for (const KeyframeId id : map_.keyframe_ids()) {
      const Keyframe& k = map_.keyframe(id);
      if (k.component != component) continue;
      essential_.keyframes.push_back(id);
      essential_.graph.nodes.push_back({Sim3(k.world_from_camera), k.parent == kNoId});
    }
  }

  void add_loops(const std::vector<LoopEdge>& loops) {
    for (const LoopEdge& loop : loops) {
      const KeyframeId a = map_.anchor_of(loop.a).keyframe;
      const KeyframeId b = map_.anchor_of(loop.b).keyframe;
      if (contains(a) && contains(b)) add_edge(a, b, loop_factor_);
    }
  }

  void add_tree_and_covisibility(int min_shared) {
    for (const KeyframeId id : essential_.keyframes) {
      const Keyframe& k = map_.keyframe(id);
      if (k.parent != kNoId) add_edge(k.parent, id, 1.0);
      for (const Covisible& c : k.covisibles) {
        if (c.keyframe < id && c.shared >= min_shared) add_edge(c.keyframe, id, 1.0);
      }
    }
  }

  EssentialGraph finish() { return std::move(essential_); }

 private:
  bool contains(KeyframeId id) const {
    return std::binary_search(essential_.keyframes.begin(), essential_.keyframes.end(), id);
  }

  void add_edge(KeyframeId a, KeyframeId b, double factor) {
    if (a == b || !known_.insert(std::minmax(a, b)).second) return;
    const SE3 a_from_b =
        map_.keyframe(a).world_from_camera.inverse() * map_.keyframe(b).world_from_camera;
    essential_.graph.edges.push_back(
        {essential_.node_of(a), essential_.node_of(b), Sim3(a_from_b), factor * information_});
  }

  const Map& map_;
  const Matrix7d information_;
  const double loop_factor_;
  EssentialGraph essential_;
  std::set<std::pair<KeyframeId, KeyframeId>> known_;
};

}  // namespace

int EssentialGraph::node_of(KeyframeId id) const {
  const auto it = std::lower_bound(keyframes.begin(), keyframes.end(), id);
  require(it != keyframes.end() && *it == id, "the keyframe is not in the essential graph");
  return static_cast<int>(it - keyframes.begin());
}

Matrix7d edge_information(const EdgeWeights& weights) {
  const double rotation_sigma = weights.rotation_sigma * std::numbers::pi / 180.0;
  const double rotation = 1.0 / (rotation_sigma * rotation_sigma);
  const double translation = 1.0 / (weights.translation_sigma * weights.translation_sigma);
  Vector7d diagonal;
  diagonal << translation, translation, translation, rotation, rotation, rotation, rotation;
  return diagonal.asDiagonal();
}

EssentialGraph make_essential_graph(const Map& map, std::uint32_t component, int min_shared,
                                    const std::vector<LoopEdge>& loops,
                                    const EdgeWeights& weights) {
  EssentialGraphBuilder builder(map, weights);
  builder.add_nodes(component);
  builder.add_loops(loops);  // first, as of two edges between the same nodes the first one counts
  builder.add_tree_and_covisibility(min_shared);
  return builder.finish();
}

double path_length(const EssentialGraph& essential, int a, int b) {
  const PoseGraph& graph = essential.graph;
  std::vector<std::vector<std::pair<int, double>>> neighbours(graph.nodes.size());
  for (const PoseGraph::Edge& edge : graph.edges) {
    const double length = edge.a_from_b.translation().norm();
    neighbours[static_cast<std::size_t>(edge.a)].emplace_back(edge.b, length);
    neighbours[static_cast<std::size_t>(edge.b)].emplace_back(edge.a, length);
  }
  std::vector<double> shortest(graph.nodes.size(), std::numeric_limits<double>::infinity());
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  shortest[static_cast<std::size_t>(a)] = 0.0;
  open.emplace(0.0, a);
  while (!open.empty()) {
    const auto [length, node] = open.top();
    open.pop();
    if (node == b) break;
    if (length > shortest[static_cast<std::size_t>(node)]) continue;
    for (const auto& [next, step] : neighbours[static_cast<std::size_t>(node)]) {
      double& known = shortest[static_cast<std::size_t>(next)];
      if (length + step >= known) continue;
      known = length + step;
      open.emplace(known, next);
    }
  }
  return shortest[static_cast<std::size_t>(b)];
}

}  // namespace dxslam
