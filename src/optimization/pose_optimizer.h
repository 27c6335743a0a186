// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/camera.h"
#include "core/frame.h"
#include "core/se3.h"

namespace dxslam {

/// A known point seen in an image.
struct PoseObservation {
  Eigen::Vector3d point_in_world;
  Measurement measured;
};

struct PoseOptimizerOptions {
  int rounds = 4;  // after each one the outliers are set aside anew
  int iterations = 10;
  double chi2_pixel = 5.991;  // 95 % of chi squared, 2 degrees of freedom
  double chi2_depth = 7.815;  // the same for 3
  int min_inliers = 6;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit("rounds", self.rounds, {1, 20}, "rounds",
          "re-weighting rounds; outliers are set aside after each");
    visit("iterations", self.iterations, {1, 100}, "steps", "Levenberg-Marquardt steps per round");
    visit("chi2_pixel", self.chi2_pixel, {0.1, 100}, "sigma^2",
          "gate of an observation without depth");
    visit("chi2_depth", self.chi2_depth, {0.1, 100}, "sigma^2",
          "gate of an observation with depth");
    visit("min_inliers", self.min_inliers, {4, 1000}, "points", "fewer inliers are a failure");
  }
  template <class Checker>
  void relate(const Checker& check) const {
    check.at_most("chi2_pixel", chi2_pixel, "chi2_depth", chi2_depth);
  }
};

struct PoseReport {
  bool success = false;      ///< enough inliers and a finite pose
  SE3 world_from_camera;     ///< the start where not successful
  std::vector<char> inlier;  ///< one per observation
  int inliers = 0;
  double rms_pixels = 0.0;  ///< over inliers, pixel part of the residual
  /// Inverse covariance of the left perturbation (rho, phi) of camera_from_world, at the solution,
  /// if the deviations of the measurements are right.
  Matrix6d information = Matrix6d::Zero();
  /// Variance of the inliers' residuals over what their deviations say: 1 where these are right.
  double variance_factor = 1.0;
};

/// Covariance of a pose found by optimize_pose(): of e in true world_from_camera =
/// world_from_camera * SE3::exp(e), e = (rho, phi) in metres and radians along the axes of the
/// camera. Arguments as in PoseReport. Nothing where the observations leave a direction open.
std::optional<Matrix6d> pose_covariance(const Matrix6d& information, double variance_factor);

/// Motion-only bundle adjustment: the camera pose that best explains the observations, by
/// Levenberg-Marquardt with a Huber kernel on (u, v) or (u, v, u - disparity) residuals.
/// The last round runs without the kernel on inliers only. Deterministic; no allocation in the
/// loop.
PoseReport optimize_pose(const Camera& camera, const SE3& world_from_camera,
                         const std::vector<PoseObservation>& observations,
                         const PoseOptimizerOptions& options);

}  // namespace dxslam
