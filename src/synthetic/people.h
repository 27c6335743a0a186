// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <vector>

#include "core/camera.h"
#include "synthetic/camera_path.h"
#include "synthetic/world.h"

namespace dxslam {

/// People who walk through the view. Each walks straight, at its own time, from one side of the
/// view to the other or towards the camera. Immutable once made, thread-safe.
class People {
 public:
  /// `density` is the mean number in view; 0 makes none. Adds the pictures of their clothes to the
  /// world.
  People(World& world, const CameraPath& path, double density, std::uint64_t seed);

  /// The surfaces of all people near the camera at `time`, lit, ready for render().
  std::vector<Surface> surfaces_at(const World& world, double time) const;
  /// How many walks there are during the path.
  std::size_t walks() const { return walks_.size(); }

 private:
  struct Walk {
    double time = 0.0;  // when the person is at `middle`
    Eigen::Vector2d middle, direction;
    double speed = 1.0;                     // metres per second
    double reach = 3.2;                     // metres before and after the middle
    double size = 1.0;                      // of the body; 1: 1.75 m tall
    int shirt = 0, trousers = 0, face = 0;  // textures
  };
  std::vector<Walk> walks_;
};

}  // namespace dxslam
