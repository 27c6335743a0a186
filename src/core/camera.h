// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>

#include "core/lens.h"

namespace dxslam {

/// Pixels from `left` to `right` and `top` to `bottom`, the ends included; holds none by default.
struct PixelBox {
  double left = 0.0, top = 0.0, right = -1.0, bottom = -1.0;

  /// False for a pixel that is not finite.
  bool contains(const Eigen::Vector2d& pixel) const {
    return pixel.x() >= left && pixel.y() >= top && pixel.x() <= right && pixel.y() <= bottom;
  }
  /// The cell, row * columns + column, of a grid over the box that a pixel lies in. A pixel outside
  /// counts to the nearest cell, one that is not a number to the first.
  std::size_t cell_of(const Eigen::Vector2f& pixel, int columns, int rows) const;
};

/// A camera with the depth sensor that is registered to it. Pixel centres are at integer
/// coordinates.
///
/// All geometry is that of an ideal pinhole with the same intrinsics: the image is undone by
/// undistort() once per keypoint, and what the lens did to its accuracy is in stretch(). Directions
/// more than kWidestAngle from the axis, which a fisheye sees, are not used: there the plane of the
/// pinhole ends, and depth along z says little.
/// Plain data; safe to copy and to share between threads once prepare() was called.
struct Camera {
  static constexpr double kNearest = 0.05;  ///< metres along z; nearer points count as out of view
  static constexpr double kWidestAngle = 75.0;  ///< degrees

  int width = 0;                                  ///< pixels
  int height = 0;                                 ///< pixels
  double fx = 0.0, fy = 0.0, cx = 0.0, cy = 0.0;  ///< pixels
  Lens lens;
  double fps = 30.0;              ///< nominal frame rate, 1/s
  double depth_factor = 1000.0;   ///< raw depth units per metre (16-bit image / factor = metres)
  double depth_baseline = 0.075;  ///< metres, between the projector or cameras of the depth sensor
  /// Standard deviation of the depth sensor's disparity, fx * baseline / depth, as a share of that
  /// of a keypoint's pixel. Nearly the same at every distance; 0.12 with a time-of-flight camera,
  /// 0.19 and 0.25 with two Kinects (docs/experiments.md).
  double disparity_noise = 0.1;
  double max_depth = 10.0;  ///< metres; farther readings count as missing
  /// Seconds from the first to the last row of an image, of a rolling shutter that starts with the
  /// topmost row; 0 for a global shutter.
  double readout_time = 0.0;

  /// Checks the values and computes view(). To be called where a camera enters the program, and
  /// again after a change. Throws InputError, naming the field, if the values cannot be those of a
  /// camera, or if the lens cannot be undistorted all over the image.
  void prepare(const std::string& where);

  bool has_distortion() const { return !lens.is_ideal(); }
  /// Whether keypoints and depths of both mean the same: size, intrinsics, lens and depth noise.
  /// How images come (fps, depth_factor, max_depth, readout_time) does not matter here.
  bool sees_as(const Camera& other) const;
  /// All values the same.
  bool operator==(const Camera& other) const;
  bool operator!=(const Camera& other) const { return !(*this == other); }
  /// Turns depth into the coordinate of a virtual right image that is as uncertain as a keypoint's
  /// pixel: disparity = bf / depth, pixels.
  double bf() const { return fx * depth_baseline / disparity_noise; }
  /// Undistorted pixel of a point in the camera frame; z must be positive.
  Eigen::Vector2d project(const Eigen::Vector3d& point_in_camera) const {
    const double inverse_z = 1.0 / point_in_camera.z();
    return {fx * point_in_camera.x() * inverse_z + cx, fy * point_in_camera.y() * inverse_z + cy};
  }
  /// Squared distance in pixels from `pixel` to where a point in the camera frame appears; infinite
  /// for a point that is not in front of the camera.
  double squared_error(const Eigen::Vector3d& point_in_camera, const Eigen::Vector2d& pixel) const {
    if (point_in_camera.z() <= 0.0) return std::numeric_limits<double>::infinity();
    return (project(point_in_camera) - pixel).squaredNorm();
  }
  /// Point in the camera frame of an undistorted pixel at `depth` metres along z.
  Eigen::Vector3d unproject(const Eigen::Vector2d& pixel, double depth) const {
    return {(pixel.x() - cx) / fx * depth, (pixel.y() - cy) / fy * depth, depth};
  }
  /// Raw (distorted) pixel of the image to the pixel of an ideal pinhole with the same intrinsics.
  /// Empty where a fisheye shows no direction that is used, see above.
  std::optional<Eigen::Vector2d> undistort(const Eigen::Vector2d& pixel) const;
  /// And back.
  Eigen::Vector2d distort(const Eigen::Vector2d& pixel) const;
  /// How many undistorted pixels one raw pixel is long at an undistorted pixel, as the geometric
  /// mean over both directions: what a distance or a standard deviation of the image is there.
  double stretch(const Eigen::Vector2d& pixel) const {
    return has_distortion() ? stretch_of_lens(pixel) : 1.0;
  }
  /// The box around all undistorted pixels of the image that are used. A barrel lens sees farther
  /// than the raw image is wide. Holds nothing where a lens was not prepared.
  PixelBox view() const {
    return has_distortion() ? undistorted_ : PixelBox{0.0, 0.0, width - 1.0, height - 1.0};
  }
  /// Whether an undistorted pixel lies in view().
  bool contains(const Eigen::Vector2d& pixel) const { return view().contains(pixel); }
  /// Undistorted pixel of a point in the camera frame; empty if it is behind the camera, nearer
  /// than kNearest or outside of view().
  std::optional<Eigen::Vector2d> project_into_view(const Eigen::Vector3d& point_in_camera) const {
    if (!(point_in_camera.z() > kNearest)) return std::nullopt;
    std::optional<Eigen::Vector2d> pixel = project(point_in_camera);
    if (!contains(*pixel)) pixel.reset();
    return pixel;
  }

 private:
  double stretch_of_lens(const Eigen::Vector2d& pixel) const;
  void measure_view(const std::string& where);
  /// Position on the plane at unit focal length of a pixel.
  Eigen::Vector2d normalised(const Eigen::Vector2d& pixel) const {
    return {(pixel.x() - cx) / fx, (pixel.y() - cy) / fy};
  }

  PixelBox undistorted_;
};

}  // namespace dxslam
