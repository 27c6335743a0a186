// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "core/rolling_shutter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <random>
#include <vector>

#include "core/test_camera.h"

namespace dxslam {
namespace {

Camera rolling_camera() {
  Camera camera = test_camera();
  camera.readout_time = 0.03;
  return camera;
}

struct Views {
  FramePtr rolling;
  std::shared_ptr<Frame> global;
};

// What the moving camera sees of random points row by row, and all at once.
Views look(const Camera& camera, const Vector6d& velocity, bool with_depth) {
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> x(-2.0, 2.0), y(-1.5, 1.5), z(1.5, 4.0);
  auto rolling = std::make_shared<Frame>();
  auto global = std::make_shared<Frame>();
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d point(x(generator), y(generator), z(generator));
    Eigen::Vector3d seen = point;
    // When a row is taken depends on the row in which the point is seen, and that on when.
    for (int step = 0; step < 20; ++step) {
      const double row = camera.project(seen).y() / camera.height - 0.5;
      seen = SE3::exp(row * camera.readout_time * velocity).inverse() * point;
    }
    if (!camera.contains(camera.project(seen))) continue;
    rolling->pixels.push_back(camera.project(seen).cast<float>());
    global->pixels.push_back(camera.project(point).cast<float>());
    rolling->depths.push_back(with_depth ? static_cast<float>(seen.z()) : 0.0F);
    global->depths.push_back(with_depth ? static_cast<float>(point.z()) : 0.0F);
  }
  return {rolling, global};
}

double farthest(const Frame& a, const Frame& b) {
  double farthest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    farthest = std::max<double>(farthest, (a.pixels[i] - b.pixels[i]).norm());
  }
  return farthest;
}

TEST(RollingShutter, IsUndoneForAnyMotionWhereDepthIsKnown) {
  const Camera camera = rolling_camera();
  Vector6d velocity;
  velocity << 0.8, -0.3, 0.5, 0.4, 1.5, -0.6;
  const Views views = look(camera, velocity, true);
  ASSERT_GT(views.rolling->size(), 100U);
  EXPECT_GT(farthest(*views.rolling, *views.global), 10.0);
  const FramePtr undone = without_rolling_shutter(views.rolling, camera, velocity);
  EXPECT_LT(farthest(*undone, *views.global), 1e-2);
  for (std::size_t i = 0; i < undone->size(); ++i) {
    EXPECT_NEAR(undone->depths[i], views.global->depths[i], 1e-4) << i;
  }
}

TEST(RollingShutter, IsUndoneForRotationsWhereDepthIsNot) {
  const Camera camera = rolling_camera();
  Vector6d velocity = Vector6d::Zero();
  velocity.tail<3>() << 0.4, 1.5, -0.6;
  const Views views = look(camera, velocity, false);
  const FramePtr undone = without_rolling_shutter(views.rolling, camera, velocity);
  EXPECT_LT(farthest(*undone, *views.global), 1e-2);
  EXPECT_FALSE(undone->has_depth(0));
}

TEST(RollingShutter, LeavesTheFrameItIsGivenAlone) {
  const Camera camera = rolling_camera();
  const Vector6d velocity = Vector6d::Constant(0.5);
  const Views views = look(camera, velocity, true);
  const std::vector<Eigen::Vector2f> before = views.rolling->pixels;
  without_rolling_shutter(views.rolling, camera, velocity);
  EXPECT_EQ(views.rolling->pixels, before);
}

TEST(RollingShutter, IsNoneAtRest) {
  const Camera camera = rolling_camera();
  const Views views = look(camera, Vector6d::Zero(), true);
  const FramePtr same = without_rolling_shutter(views.rolling, camera, Vector6d::Zero());
  EXPECT_LT(farthest(*same, *views.rolling), 1e-3);
}

}  // namespace
}  // namespace dxslam
