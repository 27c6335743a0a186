// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include "core/camera.h"

namespace dxslam {

/// The camera of made-up scenes in tests and benchmarks: about a Kinect's.
inline Camera test_camera() {
  Camera camera;
  camera.width = 640;
  camera.height = 480;
  camera.fx = 525.0;
  camera.fy = 520.0;
  camera.cx = 319.5;
  camera.cy = 239.5;
  return camera;
}

}  // namespace dxslam
