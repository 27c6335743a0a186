// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "loop_closing/loop_correction.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "core/error.h"
#include "loop_closing/keyframe_group.h"
#include "mapping/point_fusion.h"

namespace dxslam {
namespace {

constexpr double kDegrees = std::numbers::pi / 180.0;
constexpr double kAgreedLogScale = 0.01;

double angle_of(const Eigen::Quaterniond& q) { return so3_log(q).norm(); }

/// Where an edge's nodes are over where it says they are.
Sim3 edge_error(const PoseGraph& graph, const PoseGraph::Edge& edge) {
  const Sim3& a = graph.nodes[static_cast<std::size_t>(edge.a)].world_from_node;
  const Sim3& b = graph.nodes[static_cast<std::size_t>(edge.b)].world_from_node;
  return edge.a_from_b.inverse() * a.inverse() * b;
}

/// The largest change of an edge over what may be drift; the last edge is that of the loop.
double worst_bend(const PoseGraph& graph, const LoopCorrectionOptions& options) {
  double worst = 0.0;
  for (std::size_t i = 0; i + 1 < graph.edges.size(); ++i) {
    const double length = graph.edges[i].a_from_b.translation().norm();
    const Sim3 error = edge_error(graph, graph.edges[i]);
    const double translation = options.max_bend_translation + options.drift_per_metre * length;
    const double rotation =
        (options.max_bend_rotation + options.turn_per_metre * length) * kDegrees;
    worst = std::max(worst, error.translation().norm() / std::max(1e-9, translation));
    worst = std::max(worst, angle_of(error.rotation()) / std::max(1e-9, rotation));
  }
  return worst;
}

void plan_join(const Map& map, const LoopVerification& loop, LoopPlan& plan) {
  const Keyframe& query = map.keyframe(loop.query);
  const Keyframe& candidate = map.keyframe(loop.candidate);
  const SE3 candidate_world_from_query_world =
      candidate.world_from_camera * loop.candidate_from_query * query.world_from_camera.inverse();
  const bool query_is_older = query.component < candidate.component;
  plan.effect = LoopEffect::kJoin;
  plan.parent = query_is_older ? loop.query : loop.candidate;
  plan.child = query_is_older ? loop.candidate : loop.query;
  plan.kept_component = std::min(query.component, candidate.component);
  plan.joined_component = std::max(query.component, candidate.component);
  plan.parent_world_from_child_world = query_is_older ? candidate_world_from_query_world.inverse()
                                                      : candidate_world_from_query_world;
}

LoopRefusal solve(EssentialGraph& essential, const LoopVerification& loop,
                  const LoopCorrectionOptions& options, LoopPlan& plan) {
  PoseGraph& graph = essential.graph;
  const EdgeWeights weights{options.translation_sigma, options.rotation_sigma, options.loop_factor};
  const Sim3 measured(options.graph.with_scale ? loop.scale : 1.0,
                      loop.candidate_from_query.rotation(),
                      loop.candidate_from_query.translation());
  graph.edges.push_back({essential.node_of(loop.candidate), essential.node_of(loop.query), measured,
                         weights.loop_factor * edge_information(weights)});
  plan.edges = static_cast<int>(graph.edges.size());
  const PoseGraphReport report = optimize_pose_graph(graph, options.graph);
  plan.iterations = report.iterations;
  if (!report.usable) return LoopRefusal::kUnsolved;

  const Sim3 left = edge_error(graph, graph.edges.back());
  plan.loop_error = left.translation().norm();
  plan.loop_error_rotation = angle_of(left.rotation());
  plan.worst_bend = worst_bend(graph, options);
  if (plan.loop_error > options.max_loop_translation ||
      plan.loop_error_rotation > options.max_loop_rotation * kDegrees) {
    return LoopRefusal::kLoopEdge;
  }
  return plan.worst_bend > 1.0 ? LoopRefusal::kBentEdge : LoopRefusal::kNone;
}

void plan_bend(const Map& map, const LoopVerification& loop, const std::vector<LoopEdge>& closed,
               const LoopCorrectionOptions& options, LoopPlan& plan) {
  const EdgeWeights weights{options.translation_sigma, options.rotation_sigma, options.loop_factor};
  EssentialGraph essential = make_essential_graph(map, map.keyframe(loop.query).component,
                                                  options.min_shared, closed, weights);
  plan.way_round =
      path_length(essential, essential.node_of(loop.candidate), essential.node_of(loop.query));
  const double drift = options.drift_allowance + options.drift_per_metre * plan.way_round;
  const double turn = (options.turn_allowance + options.turn_per_metre * plan.way_round) * kDegrees;
  if (plan.contradiction > drift || plan.contradiction_rotation > turn) {
    plan.refusal = LoopRefusal::kDrift;
    return;
  }
  plan.refusal = solve(essential, loop, options, plan);
  if (plan.refusal != LoopRefusal::kNone) return;
  plan.effect = LoopEffect::kBend;
  plan.keyframes = std::move(essential.keyframes);
  for (const PoseGraph::Node& node : essential.graph.nodes) {
    plan.world_from_camera.push_back(node.world_from_node);
  }
}

void bend(const LoopPlan& plan, Map& map, LoopChange& change) {
  const auto index_of = [&](KeyframeId id) {
    const auto it = std::lower_bound(plan.keyframes.begin(), plan.keyframes.end(), id);
    return it != plan.keyframes.end() && *it == id ? it - plan.keyframes.begin() : -1;
  };
  const std::vector<PointId> points = map.point_ids();
  std::vector<PointId> moved;
  for (const PointId id : points) {
    const MapPoint& p = map.point(id);
    const KeyframeId reference = map.anchor_of(p.created_by).keyframe;
    const auto i = index_of(reference);
    if (i < 0) continue;
    const SE3& before = map.keyframe(reference).world_from_camera;
    map.set_position(
        id, plan.world_from_camera[static_cast<std::size_t>(i)] * (before.inverse() * p.position));
    moved.push_back(id);
  }
  for (std::size_t i = 0; i < plan.keyframes.size(); ++i) {
    const SE3 after = plan.world_from_camera[i].rigid();
    const double move =
        translation_distance(map.keyframe(plan.keyframes[i]).world_from_camera, after);
    change.largest_move = std::max(change.largest_move, move);
    map.set_pose(plan.keyframes[i], after);
  }
  for (const PointId id : moved) map.refresh_point(id);
  change.moved_keyframes = static_cast<int>(plan.keyframes.size());
  change.moved_points = static_cast<int>(moved.size());
}

void join(const LoopPlan& plan, Map& map, LoopChange& change) {
  const std::uint32_t leaving = map.keyframe(plan.child).component;
  std::set<PointId> points;
  for (const KeyframeId id : map.keyframe_ids()) {
    const Keyframe& k = map.keyframe(id);
    if (k.component != leaving) continue;
    ++change.moved_keyframes;
    const SE3 after = plan.parent_world_from_child_world * k.world_from_camera;
    change.largest_move =
        std::max(change.largest_move, translation_distance(k.world_from_camera, after));
    points.insert(k.points.begin(), k.points.end());
  }
  points.erase(kNoId);
  change.moved_points = static_cast<int>(points.size());
  map.join_components(plan.parent, plan.child, plan.parent_world_from_child_world);
}

// Binds a point to a keypoint that is known to show it.
bool bind(PointId point, KeyframeId keyframe, std::uint32_t keypoint, Map& map) {
  if (!map.has_point(point)) return false;
  const PointId present = map.keyframe(keyframe).points[keypoint];
  if (present == point) return false;
  if (present == kNoId) {
    if (!map.add_observation(point, keyframe, keypoint)) return false;
    map.refresh_point(point);
    return true;
  }
  const bool keep_present =
      map.point(present).observations.size() >= map.point(point).observations.size();
  map.merge_points(keep_present ? point : present, keep_present ? present : point);
  return true;
}

int weld(const LoopVerification& loop, const DescriptorTraits& traits,
         const LoopCorrectionOptions& options, Map& map) {
  const auto group = [&](KeyframeId id) {
    constexpr std::size_t kAll = static_cast<std::size_t>(-1);
    return gather_group(map, id, static_cast<std::size_t>(options.weld_keyframes),
                        options.weld_min_shared, kAll);
  };
  const KeyframeGroup here = group(loop.query);
  const KeyframeGroup there = group(loop.candidate);
  int fused = 0;
  for (const LoopMatch& m : loop.inlier_matches) {
    if (bind(m.point, loop.query, m.keypoint, map)) ++fused;
  }
  const PointFusion fusion{options.weld_radius, options.weld_ratio, options.weld_depth_tolerance,
                           traits};
  for (const KeyframeId id : here.keyframes) {
    fused += fuse_points(there.points, id, fusion, map);
  }
  for (const KeyframeId id : there.keyframes) {
    fused += fuse_points(here.points, id, fusion, map);
  }
  return fused;
}

}  // namespace

const char* describe(LoopEffect effect) {
  switch (effect) {
    case LoopEffect::kNone:
      return "none";
    case LoopEffect::kWeld:
      return "weld";
    case LoopEffect::kBend:
      return "bend";
    case LoopEffect::kJoin:
      return "join";
  }
  return "";
}

const char* describe(LoopRefusal refusal) {
  switch (refusal) {
    case LoopRefusal::kNone:
      return "accepted";
    case LoopRefusal::kDrift:
      return "it claims more drift than the way round allows";
    case LoopRefusal::kUnsolved:
      return "the pose graph has no solution";
    case LoopRefusal::kLoopEdge:
      return "the map cannot be bent to agree with it";
    case LoopRefusal::kBentEdge:
      return "it bends odometry or an earlier loop too far";
  }
  return "";
}

LoopPlan plan_loop_correction(const Map& map, const LoopVerification& loop,
                              const std::vector<LoopEdge>& closed,
                              const LoopCorrectionOptions& options) {
  require(loop.accepted, "only an accepted loop can be planned");
  LoopPlan plan;
  const Keyframe& query = map.keyframe(loop.query);
  const Keyframe& candidate = map.keyframe(loop.candidate);
  if (query.component != candidate.component) {
    plan_join(map, loop, plan);
    return plan;
  }
  const SE3 believed = candidate.world_from_camera.inverse() * query.world_from_camera;
  plan.contradiction = translation_distance(believed, loop.candidate_from_query);
  plan.contradiction_rotation = rotation_angle(believed, loop.candidate_from_query);
  const bool same_scale =
      !options.graph.with_scale || std::abs(std::log(loop.scale)) <= kAgreedLogScale;
  if (plan.contradiction <= options.agreed_translation &&
      plan.contradiction_rotation <= options.agreed_rotation * kDegrees && same_scale) {
    plan.effect = LoopEffect::kWeld;
  } else {
    plan_bend(map, loop, closed, options, plan);
  }
  return plan;
}

LoopChange apply_loop_plan(const LoopPlan& plan, const LoopVerification& loop,
                           const DescriptorTraits& traits, const LoopCorrectionOptions& options,
                           Map& map, std::vector<LoopEdge>& closed) {
  LoopChange change;
  if (plan.effect == LoopEffect::kNone) return change;
  if (plan.effect == LoopEffect::kBend) bend(plan, map, change);
  if (plan.effect == LoopEffect::kJoin) join(plan, map, change);
  change.fused_points = weld(loop, traits, options, map);
  closed.push_back({loop.candidate, loop.query});
  return change;
}

}  // namespace dxslam
