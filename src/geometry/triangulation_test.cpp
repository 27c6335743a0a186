// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "geometry/triangulation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "geometry/geometry_scene.h"

namespace dxslam {
namespace {

constexpr double kMinParallax = 0.01;

class TriangulationTest : public testing::Test {
 protected:
  Camera camera_ = test_camera();
  SampleSource source_{1};
  SE3 a_ = SE3::exp((Vector6d() << 0.3, -0.2, 0.5, 0.1, 0.4, -0.2).finished());
  SE3 b_ = a_ * SE3(so3_exp({0.02, -0.05, 0.03}), {0.3, 0.05, -0.02});
  std::optional<Eigen::Vector3d> meet(const SE3& a, const Eigen::Vector2d& in_a, const SE3& b,
                                      const Eigen::Vector2d& in_b, double min_parallax) const {
    return triangulate({camera_, a, in_a}, {camera_, b, in_b}, min_parallax);
  }
  Eigen::Vector2d pixel_in(const SE3& pose, const Eigen::Vector3d& x) const {
    return camera_.project(pose.inverse() * x);
  }
};

TEST_F(TriangulationTest, RecoversExactPoints) {
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector3d x =
        a_ * camera_.unproject(random_pixel(source_), source_.uniform(0.5, 6.0));
    const auto found = meet(a_, pixel_in(a_, x), b_, pixel_in(b_, x), kMinParallax);
    ASSERT_TRUE(found);
    EXPECT_LT((*found - x).norm(), 1e-9);
  }
}

TEST_F(TriangulationTest, ComesCloseToTheLeastSquaresPointUnderNoise) {
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector3d x =
        a_ * camera_.unproject(random_pixel(source_), source_.uniform(0.5, 3.0));
    const Eigen::Vector2d in_a =
        pixel_in(a_, x) + Eigen::Vector2d(source_.normal(), source_.normal());
    const Eigen::Vector2d in_b =
        pixel_in(b_, x) + Eigen::Vector2d(source_.normal(), source_.normal());
    const auto found = meet(a_, in_a, b_, in_b, kMinParallax);
    ASSERT_TRUE(found);
    const auto error = [&](const Eigen::Vector3d& p) {
      return (pixel_in(a_, p) - in_a).squaredNorm() + (pixel_in(b_, p) - in_b).squaredNorm();
    };
    const double least = error(*found);
    EXPECT_LE(least, error(x));
    for (int k = 0; k < 6; ++k) {
      const Eigen::Vector3d step = (k < 3 ? 1e-3 : -1e-3) * Eigen::Vector3d::Unit(k % 3);
      EXPECT_GE(error(*found + step), least - 1e-6);
    }
  }
}

TEST_F(TriangulationTest, MayBeOfTwoCameras) {
  Camera other = camera_;
  other.width = 320;
  other.fx = other.fy = 300.0;
  other.cx = 150.0;
  const Eigen::Vector3d x = a_ * Eigen::Vector3d(0.1, 0.2, 2.0);
  const Eigen::Vector2d in_b = other.project(b_.inverse() * x);
  const auto found = triangulate({camera_, a_, pixel_in(a_, x)}, {other, b_, in_b}, kMinParallax);
  ASSERT_TRUE(found);
  EXPECT_LT((*found - x).norm(), 1e-9);
}

TEST_F(TriangulationTest, RefusesRaysWithoutParallax) {
  const Eigen::Vector3d far = a_ * Eigen::Vector3d(1.0, 2.0, 200.0);
  EXPECT_FALSE(meet(a_, pixel_in(a_, far), b_, pixel_in(b_, far), kMinParallax));
  EXPECT_TRUE(meet(a_, pixel_in(a_, far), b_, pixel_in(b_, far), 1e-4));
  const Eigen::Vector3d x = a_ * Eigen::Vector3d(0.1, 0.2, 2.0);
  EXPECT_FALSE(meet(a_, pixel_in(a_, x), a_, pixel_in(a_, x), 0.0));
}

TEST_F(TriangulationTest, RefusesPointsBehindACamera) {
  // Diverging rays meet behind both.
  const Eigen::Vector2d left(100.0, 240.0);
  const Eigen::Vector2d right(540.0, 240.0);
  const SE3 a;
  const SE3 b(Eigen::Quaterniond::Identity(), {0.5, 0.0, 0.0});
  EXPECT_FALSE(meet(a, left, b, right, kMinParallax));
  EXPECT_TRUE(meet(a, right, b, left, kMinParallax));
}

TEST_F(TriangulationTest, RefusesValuesThatAreNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(meet(a_, {nan, 1.0}, b_, {300.0, 200.0}, kMinParallax));
  const SE3 broken(Eigen::Quaterniond::Identity(), {0.0, nan, 0.0});
  EXPECT_FALSE(meet(broken, {300.0, 210.0}, b_, {250.0, 200.0}, kMinParallax));
}

}  // namespace
}  // namespace dxslam
