// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <vector>

#include "core/camera.h"
#include "core/test_camera.h"
#include "core/transform_samples.h"

namespace dxslam {

inline Eigen::Vector2d random_pixel(SampleSource& source) {
  const double x = source.uniform(0.0, 639.0);
  return {x, source.uniform(0.0, 479.0)};
}

/// Points seen from one pose, with true pixels and depths and as many as wanted made wrong.
struct ViewScene {
  SE3 world_from_camera;
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector2d> pixels;
  std::vector<float> depths;
  std::vector<char> outlier;
};

inline ViewScene make_view_scene(SampleSource& source, int n, double outlier_share,
                                 double pixel_noise) {
  const Camera camera = test_camera();
  ViewScene scene;
  scene.world_from_camera = SE3::exp(source.tangent(1.5));
  for (int i = 0; i < n; ++i) {
    const Eigen::Vector2d pixel = random_pixel(source);
    const double depth = source.uniform(0.5, 5.0);
    const bool outlier = source.uniform(0.0, 1.0) < outlier_share;
    // A wrong match: the point is another one of the same room.
    const Eigen::Vector3d p = outlier
                                  ? camera.unproject(random_pixel(source), source.uniform(0.5, 5.0))
                                  : camera.unproject(pixel, depth);
    const double dx = pixel_noise * source.normal();
    const double dy = pixel_noise * source.normal();
    scene.points.push_back(scene.world_from_camera * p);
    scene.pixels.emplace_back(pixel.x() + dx, pixel.y() + dy);
    scene.depths.push_back(static_cast<float>(
        camera.bf() / (camera.bf() / depth + 0.5 * pixel_noise * source.normal())));
    scene.outlier.push_back(outlier ? 1 : 0);
  }
  return scene;
}

}  // namespace dxslam
