// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "core/test_camera.h"
#include "core/transform_samples.h"
#include "optimization/bundle_adjustment.h"

namespace dxslam {

/// A made-up bundle problem with its truth, for tests and benchmarks of this layer.
struct BundleSceneOptions {
  int poses = 20;
  int fixed_poses = 2;  ///< the first ones
  int points = 2500;
  int observations_per_point = 5;
  double pixel_noise = 1.0;    ///< standard deviation, pixels; also of the disparity
  double depth_share = 0.7;    ///< observations that carry a depth
  double outlier_share = 0.0;  ///< observations moved anywhere in the image
  double pose_noise = 0.02;    ///< of each tangent number of a free pose, metres and radians
  double point_noise = 0.03;   ///< of each coordinate, metres
  std::uint32_t seed = 1;
};

struct BundleScene {
  Camera camera;
  BundleProblem problem;  ///< perturbed
  std::vector<SE3> true_world_from_camera;
  std::vector<Eigen::Vector3d> true_points;
  std::vector<char> outlier;  ///< one per observation
};

class BundleSceneMaker {
 public:
  explicit BundleSceneMaker(const BundleSceneOptions& options)
      : options_(options), random_(options.seed) {}

  BundleScene make() {
    BundleScene scene;
    scene.camera = test_camera();
    scene.problem.rig = Rig(scene.camera);
    add_poses(scene);
    for (int i = 0; i < options_.points; ++i) add_point(scene, i);
    return scene;
  }

 private:
  /// Along an arc of 2 m, looking at a wall and its surroundings 1.5 to 4 m ahead.
  void add_poses(BundleScene& scene) {
    for (int i = 0; i < options_.poses; ++i) {
      const double t = options_.poses > 1 ? static_cast<double>(i) / (options_.poses - 1) : 0.5;
      Vector6d tangent;
      tangent << 2.0 * t - 1.0, 0.1 * std::sin(9.0 * t), 0.2 * std::cos(5.0 * t), 0.05 * t,
          0.4 * (0.5 - t), 0.1 * t;
      const SE3 truth = SE3::exp(tangent);
      scene.true_world_from_camera.push_back(truth);
      const bool fixed = i < options_.fixed_poses;
      Vector6d noise;
      for (int k = 0; k < 6; ++k) noise(k) = options_.pose_noise * random_.normal();
      scene.problem.poses.push_back({fixed ? truth : truth * SE3::exp(noise), fixed});
    }
  }

  void add_point(BundleScene& scene, int index) {
    const auto home = static_cast<std::size_t>(random_.uniform(0.0, options_.poses));
    const Eigen::Vector2d pixel(random_.uniform(0.0, 639.0), random_.uniform(0.0, 479.0));
    const Eigen::Vector3d truth = scene.true_world_from_camera[home] *
                                  scene.camera.unproject(pixel, random_.uniform(1.5, 4.0));
    scene.true_points.push_back(truth);
    Eigen::Vector3d noise;
    for (int k = 0; k < 3; ++k) noise(k) = options_.point_noise * random_.normal();
    scene.problem.points.emplace_back(truth + noise);

    int seen = 0;
    for (int k = 0; k < options_.poses && seen < options_.observations_per_point; ++k) {
      // The nearest poses first: home, home + 1, home - 1, ...
      const int pose = static_cast<int>(home) + (k % 2 == 1 ? (k + 1) / 2 : -k / 2);
      if (pose >= 0 && pose < options_.poses && observe(scene, pose, index, truth)) ++seen;
    }
  }

  bool observe(BundleScene& scene, int pose, int point, const Eigen::Vector3d& truth) {
    const Eigen::Vector3d p =
        scene.true_world_from_camera[static_cast<std::size_t>(pose)].inverse() * truth;
    if (p.z() < 0.3 || !scene.camera.contains(scene.camera.project(p))) return false;
    BundleProblem::Observation o;
    o.pose = pose;
    o.point = point;
    o.measured.sigma = options_.pixel_noise > 0.0 ? options_.pixel_noise : 1.0;
    o.measured.pixel = scene.camera.project(p) +
                       options_.pixel_noise * Eigen::Vector2d(random_.normal(), random_.normal());
    if (random_.uniform(0.0, 1.0) < options_.depth_share) {
      o.measured.disparity = scene.camera.bf() / p.z() + options_.pixel_noise * random_.normal();
    }
    const bool outlier = random_.uniform(0.0, 1.0) < options_.outlier_share;
    if (outlier) o.measured.pixel = {random_.uniform(0.0, 639.0), random_.uniform(0.0, 479.0)};
    scene.problem.observations.push_back(o);
    scene.outlier.push_back(outlier ? 1 : 0);
    return true;
  }

  BundleSceneOptions options_;
  SampleSource random_;
};

inline BundleScene make_bundle_scene(const BundleSceneOptions& options) {
  return BundleSceneMaker(options).make();
}

}  // namespace dxslam
