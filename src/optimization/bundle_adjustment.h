// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/frame.h"
#include "core/rig.h"
#include "core/se3.h"
#include "optimization/may_go_on.h"

namespace dxslam {

/// Poses, points and who sees what, as plain numbers: optimization knows no map.
struct BundleProblem {
  struct Pose {
    SE3 world_from_camera;
    bool fixed = false;
    CameraId camera = 0;  ///< in rig
  };
  struct Observation {
    int pose = 0;   ///< index into poses
    int point = 0;  ///< index into points
    Measurement measured;
  };
  Rig rig;
  std::vector<Pose> poses;
  std::vector<Eigen::Vector3d> points;  ///< in world
  std::vector<Observation> observations;
};

struct BundleOptions {
  int iterations = 5;         // with the robust kernel
  int refine_iterations = 5;  // after outliers were set aside
  double min_decrease = 1e-6;
  double chi2_pixel = 5.991;
  double chi2_depth = 7.815;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit("iterations", self.iterations, {1, 1000}, "steps", "steps with the robust kernel");
    visit("refine_iterations", self.refine_iterations, {0, 1000}, "steps",
          "steps after outliers were set aside");
    visit("min_decrease", self.min_decrease, {0, 1}, "",
          "share of the cost that a step must gain for another to follow");
    visit("chi2_pixel", self.chi2_pixel, {0.1, 100}, "sigma^2",
          "gate of an observation without depth");
    visit("chi2_depth", self.chi2_depth, {0.1, 100}, "sigma^2",
          "gate of an observation with depth");
  }
  template <class Checker>
  void relate(const Checker& check) const {
    check.at_most("chi2_pixel", chi2_pixel, "chi2_depth", chi2_depth);
  }
};

struct BundleReport {
  bool usable = false;     ///< the problem was changed to a finite state of no higher cost
  bool cancelled = false;  ///< it might not go on; the problem is then unchanged
  int iterations = 0;
  double initial_cost = 0.0;
  double final_cost = 0.0;
  std::vector<char> inlier;  ///< one per observation, by the gates at the solution
};

/// Bundle adjustment over all poses not fixed and all points: robust (Huber) first, then refined
/// without the observations that fail their gate. If no pose is fixed, pose 0 is held.
/// Changes poses and points in place only on success. Throws ContractError on indices out of range.
BundleReport adjust_bundle(BundleProblem& problem, const BundleOptions& options,
                           const MayGoOn& may_go_on = {});

}  // namespace dxslam
