// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "grid/occupancy_grid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "core/error.h"
#include "core/test_camera.h"

namespace dxslam {
namespace {

// A room of 6 by 4 m with a pillar, and a camera that sees its walls, floor and ceiling exactly.
constexpr double kHalfX = 3.0, kHalfY = 2.0, kCeiling = 2.5;
constexpr double kPillarX = 1.2, kPillarY = 0.5, kPillarHalf = 0.3;
constexpr double kCameraHeight = 0.6;
constexpr int kViews = 48;

Camera small_camera() {
  Camera camera = test_camera();
  camera.width = 160;
  camera.height = 120;
  camera.fx = camera.fy = 130.0;
  camera.cx = 79.5;
  camera.cy = 59.5;
  camera.prepare("test");
  return camera;
}

// Distance along a ray to where it enters the pillar, or infinity.
double to_pillar(const Eigen::Vector3d& from, const Eigen::Vector3d& ray) {
  double enter = 0.0;
  double leave = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 2; ++axis) {
    const double middle = axis == 0 ? kPillarX : kPillarY;
    double a = (middle - kPillarHalf - from[axis]) / ray[axis];
    double b = (middle + kPillarHalf - from[axis]) / ray[axis];
    if (a > b) std::swap(a, b);
    enter = std::max(enter, a);
    leave = std::min(leave, b);
  }
  return enter < leave ? enter : std::numeric_limits<double>::infinity();
}

double to_surface(const Eigen::Vector3d& from, const Eigen::Vector3d& ray) {
  double nearest = to_pillar(from, ray);
  const auto wall = [&](double at, double start, double along) {
    const double t = (at - start) / along;
    if (t > 0.0) nearest = std::min(nearest, t);
  };
  for (const double side : {-1.0, 1.0}) {
    wall(side * kHalfX, from.x(), ray.x());
    wall(side * kHalfY, from.y(), ray.y());
  }
  wall(0.0, from.z(), ray.z());
  wall(kCeiling, from.z(), ray.z());
  return nearest;
}

// Looks level into direction `bearing`: the camera's z along it, its y down.
SE3 pose_at(double x, double y, double bearing) {
  Eigen::Matrix3d rotation;
  rotation.col(2) = Eigen::Vector3d(std::cos(bearing), std::sin(bearing), 0.0);
  rotation.col(1) = -Eigen::Vector3d::UnitZ();
  rotation.col(0) = rotation.col(1).cross(rotation.col(2));
  return {rotation, Eigen::Vector3d(x, y, kCameraHeight)};
}

SE3 view(int i) {
  const double turn = 2.0 * std::numbers::pi * i / kViews;
  return pose_at(-0.8 + 0.7 * std::cos(turn), -0.6 + 0.7 * std::sin(turn), 5.0 * turn);
}

cv::Mat depth_at(const Camera& camera, const SE3& map_from_camera) {
  cv::Mat depth(camera.height, camera.width, CV_32FC1);
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const Eigen::Vector3d ray =
          map_from_camera.rotation() *
          camera.unproject({static_cast<double>(u), static_cast<double>(v)}, 1.0);
      depth.at<float>(v, u) = static_cast<float>(to_surface(map_from_camera.translation(), ray));
    }
  }
  return depth;
}

// Of the free floor in the image and the true one: what both have of what either has.
double overlap(const GridImage& image) {
  int both = 0;
  int either = 0;
  const double step = 0.05;
  for (double x = -kHalfX - 1.0 + step / 2; x < kHalfX + 1.0; x += step) {
    for (double y = -kHalfY - 1.0 + step / 2; y < kHalfY + 1.0; y += step) {
      const bool in_room = std::abs(x) < kHalfX && std::abs(y) < kHalfY;
      const bool in_pillar =
          std::abs(x - kPillarX) < kPillarHalf && std::abs(y - kPillarY) < kPillarHalf;
      const bool is_free = in_room && !in_pillar;
      const bool says_free = image.at(x, y) == GridImage::kFree;
      both += static_cast<int>(is_free && says_free);
      either += static_cast<int>(is_free || says_free);
    }
  }
  return static_cast<double>(both) / either;
}

GridOptions options() {
  GridOptions options;
  options.max_range = 8.0;
  options.pixel_step = 1;
  return options;
}

TEST(OccupancyGrid, IsTheFloorPlan) {
  const Camera camera = small_camera();
  FloorScanner scanner(camera, options());
  OccupancyGrid grid(options());
  EXPECT_TRUE(grid.image().cells.empty());
  for (int i = 0; i < kViews; ++i) {
    grid.set(static_cast<std::uint32_t>(i), scanner.scan(depth_at(camera, view(i)), view(i)),
             view(i));
  }
  const GridImage image = grid.image();
  EXPECT_GT(overlap(image), 0.9);
  EXPECT_EQ(image.at(kPillarX - kPillarHalf + 0.01, kPillarY), GridImage::kOccupied);
  EXPECT_EQ(image.at(-kHalfX - 0.01, 0.0), GridImage::kOccupied);
  EXPECT_EQ(image.at(100.0, 0.0), GridImage::kUnknown);
  EXPECT_EQ(image.at(-0.8, -0.6), GridImage::kFree);
}

TEST(OccupancyGrid, FollowsALoopClosure) {
  const Camera camera = small_camera();
  FloorScanner scanner(camera, options());
  OccupancyGrid grid(options());
  OccupancyGrid right(options());
  for (int i = 0; i < kViews; ++i) {
    // What tracking believed: it drifts by a metre and 30 degrees.
    const double drift = static_cast<double>(i) / kViews;
    const SE3 believed =
        SE3(so3_exp({0.0, 0.0, 0.5 * drift}), {drift, -0.5 * drift, 0.0}) * view(i);
    const FloorScan scan = scanner.scan(depth_at(camera, view(i)), believed);
    grid.set(static_cast<std::uint32_t>(i), scan, believed);
    right.set(static_cast<std::uint32_t>(i), scan, view(i));
  }
  EXPECT_LT(overlap(grid.image()), 0.8);
  for (int i = 0; i < kViews; ++i) grid.move(static_cast<std::uint32_t>(i), view(i));
  EXPECT_GT(overlap(grid.image()), 0.9);
  EXPECT_EQ(grid.image().cells, right.image().cells) << "nothing is left of what was believed";
}

TEST(OccupancyGrid, ForgetsWhatIsRemoved) {
  const Camera camera = small_camera();
  FloorScanner scanner(camera, options());
  OccupancyGrid grid(options());
  for (std::uint32_t i = 0; i < 3; ++i) {
    const SE3 pose = view(static_cast<int>(i));
    grid.set(i, scanner.scan(depth_at(camera, pose), pose), pose);
  }
  grid.set(1, FloorScan{}, view(1));  // replaces
  for (std::uint32_t i = 0; i < 5; ++i) grid.remove(i);
  EXPECT_EQ(grid.scan_count(), 0U);
  EXPECT_TRUE(grid.image().cells.empty());
  grid.move(7, view(7));
}

TEST(OccupancyGrid, LeavesOutWhatIsTooFarOrNoNumber) {
  OccupancyGrid grid(options());
  FloorScan scan;
  scan.rays = {{{0.0F, 0.0F, 1e6F}, true},
               {{0.0F, 0.0F, std::numeric_limits<float>::quiet_NaN()}, true},
               {{0.0F, 0.0F, 2.0F}, true}};
  grid.set(1, scan, pose_at(0.0, 0.0, 0.0));
  EXPECT_EQ(grid.image().width, 40) << "two metres, but no obstacle yet: one image shows it";
  grid.set(2, scan, pose_at(1e9, 0.0, 0.0));
  EXPECT_EQ(grid.image().width, 40);
}

TEST(FloorScanner, SeesOverWhatIsLowAndUnderWhatIsHigh) {
  const Camera camera = small_camera();
  GridOptions low = options();
  FloorScanner scanner(camera, low);
  const SE3 pose = pose_at(0.0, 0.0, 0.0);
  EXPECT_TRUE(scanner.scan(cv::Mat::zeros(120, 160, CV_32FC1), pose).rays.empty());
  cv::Mat depth = cv::Mat::zeros(120, 160, CV_32FC1);
  depth.rowRange(100, 120).setTo(1.0F);  // 0.3 m below the camera and lower
  for (const FloorScan::Ray& ray : scanner.scan(depth, pose).rays) EXPECT_TRUE(ray.is_blocked);
  low.min_height = 0.4;
  const FloorScan free = FloorScanner(camera, low).scan(depth, pose);
  EXPECT_FALSE(free.rays.empty());
  for (const FloorScan::Ray& ray : free.rays) EXPECT_FALSE(ray.is_blocked);
  EXPECT_THROW(scanner.scan(cv::Mat::zeros(12, 16, CV_32FC1), pose), ContractError);
  low.min_height = 3.0;
  EXPECT_THROW(FloorScanner(camera, low), InputError);
}

}  // namespace
}  // namespace dxslam
