// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

#include "core/camera.h"
#include "core/se3.h"
#include "grid/grid_options.h"

namespace dxslam {

/// What one depth image says about the floor around the camera: as far as it is free, direction by
/// direction. Moves along with the camera, so that it stays right when the map bends.
struct FloorScan {
  struct Ray {
    Eigen::Vector3f end_in_camera;  ///< metres; where the free way ends
    bool is_blocked = false;        ///< by something that stands there; else nothing more was seen
  };
  std::vector<Ray> rays;
};

/// Makes floor scans of depth images of one camera. Not for two threads at once.
class FloorScanner {
 public:
  /// The camera must be prepared. Throws InputError for options out of range.
  FloorScanner(const Camera& camera, const GridOptions& options);

  /// `depth`: CV_32FC1, metres, of the camera's size, 0 = no reading. `map_from_camera`: in a map
  /// whose z points up and whose floor is at z = 0. Where the camera sees neither floor nor
  /// anything that stands on it, there are no rays.
  FloorScan scan(const cv::Mat& depth, const SE3& map_from_camera);

 private:
  struct Direction {
    int row = 0, column = 0;
    Eigen::Vector3f ray;  // point in the camera frame at z = 1
  };
  // What a direction on the floor has shown of one image.
  struct Bearing {
    float free_range = 0.0F;
    Eigen::Vector3f free_end;
    std::vector<std::pair<float, Eigen::Vector3f>> obstacles;  // the nearest, by range
  };

  void add(const Eigen::Vector3f& point_in_camera, const Eigen::Vector3f& offset, float height);
  Bearing& bearing_of(const Eigen::Vector3f& offset);

  GridOptions options_;
  int width_, height_;
  std::vector<Direction> directions_;
  std::vector<Bearing> bearings_;
};

}  // namespace dxslam
