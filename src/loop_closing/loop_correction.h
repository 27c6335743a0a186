// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstdint>
#include <vector>

#include "core/camera.h"
#include "core/features.h"
#include "core/sim3.h"
#include "loop_closing/essential_graph.h"
#include "loop_closing/loop_closing_options.h"
#include "loop_closing/loop_verification.h"
#include "map/map.h"
#include "optimization/pose_graph.h"

namespace dxslam {

/// What a verified loop means for the map.
enum class LoopEffect {
  kNone,  ///< refused: see LoopPlan::refusal
  kWeld,  ///< the map agrees already; points seen from both ends are fused
  kBend,  ///< keyframes and points move to close the loop, then points are fused
  kJoin,  ///< two components become one, then points are fused
};
const char* describe(LoopEffect effect);

/// Why a verified loop is not believed, in the order in which it is asked.
enum class LoopRefusal {
  kNone,
  kDrift,     ///< it claims more drift than the way round allows
  kUnsolved,  ///< the pose graph has no solution
  kLoopEdge,  ///< optimisation leaves too much of the contradiction
  kBentEdge,  ///< optimisation bends another edge (odometry or an earlier loop) too far
};
const char* describe(LoopRefusal refusal);

/// How a map would change by a loop. Made without touching the map.
struct LoopPlan {
  LoopEffect effect = LoopEffect::kNone;
  LoopRefusal refusal = LoopRefusal::kNone;
  double contradiction = 0.0;           ///< metres between the loop and the map; 0 for kJoin
  double contradiction_rotation = 0.0;  ///< radians
  double way_round = 0.0;               ///< metres along the map, see path_length
  double loop_error = 0.0;              ///< metres that remain at the loop's edge
  double loop_error_rotation = 0.0;     ///< radians
  double worst_bend = 0.0;              ///< of an edge over what it may; above 1 refuses
  int edges = 0;                        ///< of the pose graph
  int iterations = 0;

  std::vector<KeyframeId> keyframes;         ///< kBend: all that take part, rising
  std::vector<Sim3> world_from_camera;       ///< kBend: where they go, one per keyframe
  KeyframeId parent = kNoId, child = kNoId;  ///< kJoin, see Map::join_components
  SE3 parent_world_from_child_world;         ///< kJoin
  std::uint32_t kept_component = 0, joined_component = 0;  ///< kJoin: the second is no more
};

/// Works out what an accepted `loop` does to the map, and whether the map and the loops closed
/// before can live with it. Keyframes move by pose graph optimisation over the essential graph;
/// with options.graph.with_scale they take the drift in scale out as well. Two components are
/// joined into the one that began first.
LoopPlan plan_loop_correction(const Map& map, const LoopVerification& loop,
                              const std::vector<LoopEdge>& closed,
                              const LoopCorrectionOptions& options);

struct LoopChange {
  int moved_keyframes = 0;
  int moved_points = 0;
  int fused_points = 0;
  double largest_move = 0.0;  ///< metres, of a keyframe
};

/// Carries out a plan made from this state of the map: moves keyframes and, with the keyframe that
/// made each, points; fuses what is seen from both ends; remembers the loop in `closed`. A plan
/// without effect changes nothing.
LoopChange apply_loop_plan(const LoopPlan& plan, const LoopVerification& loop,
                           const DescriptorTraits& traits, const LoopCorrectionOptions& options,
                           Map& map, std::vector<LoopEdge>& closed);

}  // namespace dxslam
