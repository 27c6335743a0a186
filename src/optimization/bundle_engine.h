// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/se3.h"
#include "geometry/reprojection.h"
#include "optimization/bundle_adjustment.h"

namespace dxslam {

// What the solvers behind adjust_bundle have in common. Internal to this layer.

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
  std::vector<char> active;  ///< one an observation
  std::vector<char> held;    ///< one per pose
  bool robust = true;        ///< Huber kernel whose width is the gate of the observation
  int iterations = 0;
  MayGoOn may_go_on;
};

struct BundleStageReport {
  bool usable = false;     ///< the state is finite and of no higher cost than at the start
  bool cancelled = false;  ///< it might not go on; the state is then of no use
  int iterations = 0;
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

/// Derivative of bundle_residual by the point in the camera frame.
inline Eigen::Matrix3d bundle_jacobian(const Camera& camera, const BundleProblem::Observation& o,
                                       const Eigen::Vector3d& in_camera) {
  if (!(in_camera.z() > kMinProjectionDepth)) return Eigen::Matrix3d::Zero();
  Eigen::Matrix3d j = project_stereo_jacobian(camera, in_camera) / o.sigma;
  if (!has_depth(o)) j.row(2).setZero();
  return j;
}

/// Minimises by Ceres; any size. Bit-identical over repeats if options.threads is 1.
BundleStageReport minimise_with_ceres(const BundleStage& stage, BundleState& state);

/// Minimises by the own solver, in one thread whatever options.threads says; memory grows with the
/// square and time with the cube of the free poses. Always bit-identical over repeats.
BundleStageReport minimise_with_schur(const BundleStage& stage, BundleState& state);

}  // namespace dxslam
