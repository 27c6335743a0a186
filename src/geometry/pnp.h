// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/camera.h"
#include "core/se3.h"

namespace dxslam {

struct PnpOptions {
  int iterations = 300;
  double confidence = 0.999;
  double threshold = 4.0;  // pixels
  int min_inliers = 10;
  int seed = 1;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit("iterations", self.iterations, {1, 100000}, "samples", "most samples drawn");
    visit("confidence", self.confidence, {0.5, 0.999999}, "",
          "wanted probability of one clean sample");
    visit("threshold", self.threshold, {0.1, 100}, "pixels", "reprojection error of an inlier");
    visit("min_inliers", self.min_inliers, {4, 100000}, "points", "fewer inliers are a failure");
    visit("seed", self.seed, {0, 2147483647}, "", "seed of the sampler");
  }
};

struct PnpReport {
  SE3 world_from_camera;
  std::vector<char> inlier;  ///< one per correspondence
  int inliers = 0;
};

/// Camera pose from 3-D points and their undistorted pixels by RANSAC with local optimisation.
/// Where `depths` (metres, 0 = none; empty = none at all) are given they must agree with the pose
/// within 10 % as well. Nothing is returned if no pose with min_inliers was found. Deterministic.
std::optional<PnpReport> solve_pnp(const Camera& camera,
                                   const std::vector<Eigen::Vector3d>& points_in_world,
                                   const std::vector<Eigen::Vector2d>& pixels,
                                   const std::vector<float>& depths, const PnpOptions& options);

}  // namespace dxslam
