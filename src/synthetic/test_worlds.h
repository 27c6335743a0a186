// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include "core/camera.h"
#include "synthetic/synthetic_options.h"
#include "synthetic/world.h"

namespace dxslam::testing_worlds {

inline Camera small_camera() {
  Camera camera;
  camera.width = 160;
  camera.height = 120;
  camera.fx = camera.fy = 130.0;
  camera.cx = 79.5;
  camera.cy = 59.5;
  return camera;
}

/// A rectangle across the optical axis of a camera at the origin of the world, evenly lit.
inline Surface facing_rectangle(double left, double top, double width, double height, double z) {
  Surface s;
  s.corner = {left, top, z};
  s.edge_u = {width, 0, 0};
  s.edge_v = {0, height, 0};
  s.light = {2, 2, std::vector<Eigen::Vector3f>(4, Eigen::Vector3f::Ones())};
  return s;
}

/// The room, small and without sensor noise; 2 frames a second.
inline SyntheticOptions quiet_room() {
  SyntheticOptions options;
  options.width = 320;
  options.height = 240;
  options.fps = 2.0;
  options.factors.image_noise = 0.0;
  options.factors.depth_noise = 0.0;
  return options;
}

}  // namespace dxslam::testing_worlds
