// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstdint>
#include <vector>

#include "core/camera.h"
#include "core/features.h"
#include "core/sim3.h"
#include "loop_closing/essential_graph.h"
#include "loop_closing/loop_verification.h"
#include "map/map.h"
#include "optimization/pose_graph.h"

namespace dxslam {

struct LoopCorrectionOptions {
  double agreed_translation = 0.03;
  double agreed_rotation = 0.5;
  double drift_allowance = 0.5;
  double drift_per_metre = 0.1;
  double turn_allowance = 10.0;
  double turn_per_metre = 1.0;
  int min_shared = 80;
  double translation_sigma = 0.05;
  double rotation_sigma = 0.5;
  double loop_factor = 1000.0;
  double max_loop_translation = 0.05;
  double max_loop_rotation = 1.0;
  double max_bend_translation = 0.05;
  double max_bend_rotation = 2.0;
  int weld_keyframes = 8;
  int weld_min_shared = 15;
  double weld_radius = 8.0;
  double weld_ratio = 0.95;
  double weld_depth_tolerance = 0.1;
  PoseGraphOptions graph{50};

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit("agreed_translation", self.agreed_translation, {0, 10}, "m",
          "a loop that contradicts the map by less moves nothing, but fuses points");
    visit("agreed_rotation", self.agreed_rotation, {0, 180}, "degrees", "the same for rotation");
    visit("drift_allowance", self.drift_allowance, {0, 1000}, "m",
          "drift that a loop may claim whatever the length of the way round");
    visit("drift_per_metre", self.drift_per_metre, {0, 1}, "", "and so much more for each metre");
    visit("turn_allowance", self.turn_allowance, {0, 180}, "degrees",
          "drift in rotation that a loop may claim");
    visit("turn_per_metre", self.turn_per_metre, {0, 180}, "degrees", "and so much more for each");
    visit("min_shared", self.min_shared, {1, 100000}, "points",
          "that covisible keyframes must share to be tied in the pose graph");
    visit("translation_sigma", self.translation_sigma, {1e-6, 100}, "m",
          "standard deviation of an edge of the pose graph");
    visit("rotation_sigma", self.rotation_sigma, {1e-6, 180}, "degrees", "the same for rotation");
    visit("loop_factor", self.loop_factor, {1, 1e9}, "",
          "how much more a loop's edge weighs than others");
    visit("max_loop_translation", self.max_loop_translation, {0, 100}, "m",
          "what may remain of the contradiction");
    visit("max_loop_rotation", self.max_loop_rotation, {0, 180}, "degrees",
          "the same for rotation");
    visit("max_bend_translation", self.max_bend_translation, {0, 100}, "m",
          "by how much any other edge may change, beyond the drift of its length");
    visit("max_bend_rotation", self.max_bend_rotation, {0, 180}, "degrees",
          "the same for rotation");
    visit("weld_keyframes", self.weld_keyframes, {1, 1000}, "keyframes",
          "on either side of the loop whose points are fused");
    visit("weld_min_shared", self.weld_min_shared, {1, 100000}, "points",
          "that each of them shares with the query or the candidate");
    visit("weld_radius", self.weld_radius, {0.5, 100}, "pixels at 640 wide",
          "window around the pixel of a point to fuse");
    visit("weld_ratio", self.weld_ratio, {0.1, 1}, "",
          "nearest to second nearest descriptor distance");
    visit("weld_depth_tolerance", self.weld_depth_tolerance, {0.001, 10}, "",
          "relative difference of predicted and measured depth");
    visit.group("graph", self.graph);
  }
};

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
