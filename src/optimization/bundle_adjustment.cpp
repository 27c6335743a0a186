// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "optimization/bundle_adjustment.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "optimization/bundle_engine.h"
#include "optimization/huber.h"

namespace dxslam {
namespace {

void check_indices(const BundleProblem& problem) {
  const auto inside = [](int index, std::size_t size) {
    return index >= 0 && static_cast<std::size_t>(index) < size;
  };
  for (const BundleProblem::Observation& o : problem.observations) {
    require(inside(o.pose, problem.poses.size()), "bundle observation of a pose that is not there");
    require(inside(o.point, problem.points.size()),
            "bundle observation of a point that is not there");
  }
  for (const BundleProblem::Pose& pose : problem.poses) {
    require(problem.rig.has(pose.camera), "bundle pose of a camera that is not in the rig");
  }
}

BundleState initial_state(const BundleProblem& problem) {
  BundleState state;
  state.camera_from_world.reserve(problem.poses.size());
  for (const BundleProblem::Pose& pose : problem.poses) {
    state.camera_from_world.push_back(pose.world_from_camera.inverse());
  }
  state.points = problem.points;
  return state;
}

std::vector<char> held_poses(const BundleProblem& problem) {
  std::vector<char> held;
  held.reserve(problem.poses.size());
  for (const BundleProblem::Pose& pose : problem.poses) held.push_back(pose.fixed ? 1 : 0);
  if (!held.empty() && std::find(held.begin(), held.end(), 1) == held.end()) held.front() = 1;
  return held;
}

Eigen::Vector3d in_camera(const BundleState& state, const BundleProblem::Observation& o) {
  return state.camera_from_world[static_cast<std::size_t>(o.pose)] *
         state.points[static_cast<std::size_t>(o.point)];
}

/// Observations in front of their camera, which is what the first stage can use.
std::vector<char> visible(const BundleProblem& problem, const BundleState& state) {
  std::vector<char> mask;
  mask.reserve(problem.observations.size());
  for (const BundleProblem::Observation& o : problem.observations) {
    mask.push_back(o.measured.is_finite() && in_camera(state, o).z() > kMinProjectionDepth ? 1 : 0);
  }
  return mask;
}

/// Whether every pose and point that takes part is finite.
bool finite(const BundleProblem& problem, const BundleState& state, const std::vector<char>& mask) {
  for (std::size_t i = 0; i < mask.size(); ++i) {
    if (mask[i] != 0 && !in_camera(state, problem.observations[i]).allFinite()) return false;
  }
  return true;
}

std::vector<char> classify(const BundleStage& stage, const BundleState& state) {
  std::vector<char> mask = visible(*stage.problem, state);
  for (std::size_t i = 0; i < mask.size(); ++i) {
    if (mask[i] == 0) continue;
    const BundleProblem::Observation& o = stage.problem->observations[i];
    const double error2 =
        bundle_residual(camera_of(*stage.problem, o), o, in_camera(state, o)).squaredNorm();
    mask[i] = error2 <= bundle_gate2(o, *stage.options) ? 1 : 0;
  }
  return mask;
}

/// Half the sum of Huber costs over `mask`.
double robust_cost(const BundleStage& stage, const BundleState& state,
                   const std::vector<char>& mask) {
  double sum = 0.0;
  double weight = 1.0;
  for (std::size_t i = 0; i < mask.size(); ++i) {
    if (mask[i] == 0) continue;
    const BundleProblem::Observation& o = stage.problem->observations[i];
    const double error2 =
        bundle_residual(camera_of(*stage.problem, o), o, in_camera(state, o)).squaredNorm();
    sum += huber(error2, bundle_gate2(o, *stage.options), weight);
  }
  return 0.5 * sum;
}

/// Both stages from `state` on. The first stage's result stands where the second one, which has
/// another objective, would raise the cost above that of the start.
void minimise(BundleStage& stage, BundleState& state, BundleReport& report) {
  const std::vector<char> considered = stage.active;
  report.initial_cost = report.final_cost = robust_cost(stage, state, considered);
  const DescentReport first = minimise_bundle(stage, state);
  report.iterations = first.iterations;
  report.cancelled = first.cancelled;
  if (!first.usable) return;
  report.final_cost = robust_cost(stage, state, considered);

  if (stage.options->refine_iterations > 0) {
    stage.active = classify(stage, state);
    stage.robust = false;
    stage.iterations = stage.options->refine_iterations;
    BundleState refined = state;
    const DescentReport second = minimise_bundle(stage, refined);
    report.iterations += second.iterations;
    report.cancelled = second.cancelled;
    if (second.cancelled) return;
    const double cost = robust_cost(stage, refined, considered);
    if (second.usable && cost <= report.initial_cost) {
      state = std::move(refined);
      report.final_cost = cost;
    }
  }
  report.usable =
      finite(*stage.problem, state, considered) && report.final_cost <= report.initial_cost;
}

void write_back(const BundleStage& stage, const BundleState& state, BundleProblem& problem) {
  for (std::size_t i = 0; i < problem.poses.size(); ++i) {
    if (stage.held[i] == 0) {
      problem.poses[i].world_from_camera = state.camera_from_world[i].inverse();
    }
  }
  problem.points = state.points;
}

}  // namespace

BundleReport adjust_bundle(BundleProblem& problem, const BundleOptions& options,
                           const MayGoOn& may_go_on) {
  check_indices(problem);
  BundleState state = initial_state(problem);
  BundleReport report;
  report.inlier.assign(problem.observations.size(), 0);

  BundleStage stage;
  stage.problem = &problem;
  stage.options = &options;
  stage.active = visible(problem, state);
  stage.held = held_poses(problem);
  stage.iterations = options.iterations;
  stage.may_go_on = may_go_on;
  if (must_stop(stage.may_go_on)) {
    report.cancelled = true;
    return report;
  }
  minimise(stage, state, report);
  if (!report.usable) state = initial_state(problem);
  report.inlier = classify(stage, state);
  if (report.usable) write_back(stage, state, problem);
  return report;
}

}  // namespace dxslam
