// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "core/camera.h"
#include "core/se3.h"
#include "synthetic/world.h"

namespace dxslam {

/// What an ideal sensor sees. Pixel centres are at integer coordinates.
struct Rendering {
  cv::Mat radiance;   ///< CV_32FC3, linear BGR times the world's exposure; 1 saturates
  cv::Mat depth;      ///< CV_32FC1 metres along z at the pixel centre; 0 where nothing is seen
  cv::Mat incidence;  ///< CV_32FC1 cosine between the line of sight and the surface's normal
  cv::Mat surface;    ///< CV_32SC1 index into World::surfaces, then into `extra`; -1 for nothing
};

struct RenderOptions {
  int threads = 1;        ///< rows are shared out; the result is the same bit by bit
  bool antialias = true;  ///< four more samples for pixels on the border of a surface
  double shift_x = 0.0;   ///< pixels added to every pixel centre, for jittered averages
  double shift_y = 0.0;
};

/// Draws the world for an undistorted pinhole camera: visibility by inverse depth, then one
/// filtered texture sample a pixel times the baked light. `extra` are surfaces of the moment
/// (people), lit by their own grid. Throws ContractError for a camera with distortion.
Rendering render(const World& world, const std::vector<Surface>& extra, const Camera& camera,
                 const SE3& world_from_camera, const RenderOptions& options);

}  // namespace dxslam
