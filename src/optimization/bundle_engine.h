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
  const Camera* camera = nullptr;
  const BundleProblem* problem = nullptr;  ///< observations only; poses and points are in the state
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

inline bool has_depth(const BundleProblem::Observation& o) { return o.disparity > 0.0; }

/// Squared gate, which is the squared width of the Huber kernel, too; in units of sigma.
inline double bundle_gate2(const BundleProblem::Observation& o, const BundleOptions& options) {
  return has_depth(o) ? options.chi2_depth : options.chi2_pixel;
}

/// (u, v, u - disparity) minus measurement, over sigma; the last is 0 without depth. A point with
/// no projection counts as an image width off.
inline Eigen::Vector3d bundle_residual(const Camera& camera, const BundleProblem::Observation& o,
                                       const Eigen::Vector3d& in_camera) {
  if (!(in_camera.z() > kMinProjectionDepth)) return {camera.width / o.sigma, 0.0, 0.0};
  const Eigen::Vector3d measured(o.pixel.x(), o.pixel.y(), o.pixel.x() - o.disparity);
  Eigen::Vector3d r = (project_stereo(camera, in_camera) - measured) / o.sigma;
  if (!has_depth(o)) r.z() = 0.0;
  return r;
}

/// Minimises in one thread; bit-identical over repeats.
DescentReport minimise_bundle(const BundleStage& stage, BundleState& state);

}  // namespace dxslam
