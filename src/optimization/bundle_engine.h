// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/se3.h"
#include "geometry/reprojection.h"
#include "optimization/bundle_adjustment.h"
#include "optimization/levenberg_marquardt.h"

namespace dxslam {

// The solver behind adjust_bundle. Internal to this layer.

/// The unknowns of a bundle problem.
struct BundleState {
  std::vector<SE3> camera_from_world;   ///< one per pose
  std::vector<Eigen::Vector3d> points;  ///< in world
};

/// One minimisation: which observations and poses take part, and how long it may go on.
struct BundleStage {
  /// Observations and cameras only; poses and points are in the state.
  const BundleProblem* problem = nullptr;
  const BundleOptions* options = nullptr;
  std::vector<char> active;  ///< one per observation
  std::vector<char> held;    ///< one per pose
  bool robust = true;        ///< Huber kernel whose width is the gate of the observation
  int iterations = 0;
  MayGoOn may_go_on;
  /// With more free poses the system that is left after the points were eliminated is sparse;
  /// else its memory grows with the square and its time with the cube of their number.
  int max_dense_poses = 400;
  double max_coupled_share =
      0.25;  ///< of pairs of poses with common points; more are solved densely
};

/// Squared gate, which is the squared width of the Huber kernel, too; in units of sigma.
inline double bundle_gate2(const BundleProblem::Observation& o, const BundleOptions& options) {
  return o.measured.has_disparity() ? options.chi2_depth : options.chi2_pixel;
}

/// The camera that took an observation.
inline const Camera& camera_of(const BundleProblem& problem, const BundleProblem::Observation& o) {
  return problem.rig.cameras()[problem.poses[static_cast<std::size_t>(o.pose)].camera];
}

/// stereo_residual over sigma. A point with no projection counts as an image width off.
inline Eigen::Vector3d bundle_residual(const Camera& camera, const BundleProblem::Observation& o,
                                       const Eigen::Vector3d& in_camera) {
  const double sigma = o.measured.sigma;
  if (!(in_camera.z() > kMinProjectionDepth)) return {camera.width / sigma, 0.0, 0.0};
  return stereo_residual(camera, o.measured, in_camera) / sigma;
}

/// Minimises in one thread; bit-identical over repeats.
DescentReport minimise_bundle(const BundleStage& stage, BundleState& state);

}  // namespace dxslam
