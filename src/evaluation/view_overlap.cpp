// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "evaluation/view_overlap.h"

#include <cmath>

#include "core/error.h"

namespace dxslam {
namespace {

constexpr int kStep = 8;            // pixels between two of the depth readings that are kept
constexpr int kPointStep = 5;       // of these between two points
constexpr double kAgreement = 0.1;  // of the distance
constexpr double kNearest = 0.1;    // metres

}  // namespace

DepthView::DepthView(const cv::Mat& depth, const Camera& camera, const SE3& world_from_camera)
    : camera_(camera),
      camera_from_world_(world_from_camera.inverse()),
      depth_((depth.rows + kStep - 1) / kStep, (depth.cols + kStep - 1) / kStep, CV_32F) {
  require(depth.type() == CV_32FC1 && depth.cols == camera.width && depth.rows == camera.height,
          "a depth image of the camera's size");
  for (int y = 0; y < depth_.rows; ++y) {
    for (int x = 0; x < depth_.cols; ++x) {
      const float z = depth.at<float>(y * kStep, x * kStep);
      depth_.at<float>(y, x) = z;
      if (z <= 0.0F || y % kPointStep != 0 || x % kPointStep != 0) continue;
      const std::optional<Eigen::Vector2d> pixel = camera.undistort({x * kStep, y * kStep});
      if (!pixel) continue;
      points_.push_back((world_from_camera * camera.unproject(*pixel, z)).cast<float>());
    }
  }
}

double DepthView::share_seen_by(const DepthView& other) const {
  int counted = 0;
  int seen = 0;
  for (const Eigen::Vector3f& point : points_) {
    const Eigen::Vector3d p = other.camera_from_world_ * point.cast<double>();
    const float surface = p.z() < kNearest ? -1.0F : other.depth_at(p);
    if (surface == 0.0F) continue;
    ++counted;
    if (std::abs(surface - p.z()) < kAgreement * p.z()) ++seen;
  }
  return counted == 0 ? 0.0 : static_cast<double>(seen) / counted;
}

float DepthView::depth_at(const Eigen::Vector3d& point) const {
  const Eigen::Vector2d undistorted = camera_.project(point);
  if (!camera_.contains(undistorted)) return -1.0F;
  const Eigen::Vector2d pixel = camera_.distort(undistorted);
  const PixelBox image{0.0, 0.0, camera_.width - 1.0, camera_.height - 1.0};
  if (!image.contains(pixel)) return -1.0F;
  const int x = std::min(depth_.cols - 1, static_cast<int>(std::lround(pixel.x() / kStep)));
  const int y = std::min(depth_.rows - 1, static_cast<int>(std::lround(pixel.y() / kStep)));
  return depth_.at<float>(y, x);
}

bool views_overlap(const DepthView& a, const DepthView& b, double least) {
  return a.share_seen_by(b) >= least || b.share_seen_by(a) >= least;
}

}  // namespace dxslam
