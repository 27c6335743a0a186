// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "core/camera.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/error.h"

namespace dxslam {
namespace {

using testing::AllOf;
using testing::HasSubstr;

Camera freiburg1() {
  Camera c;
  c.width = 640;
  c.height = 480;
  c.fx = 517.306408;
  c.fy = 516.469215;
  c.cx = 318.643040;
  c.cy = 255.313989;
  c.k1 = 0.262383;
  c.k2 = -0.953104;
  c.p1 = -0.005358;
  c.p2 = 0.002628;
  c.k3 = 1.163314;
  return c;
}

std::string refusal(const Camera& camera) {
  try {
    camera.validate("calib.yaml");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Camera, UnprojectInvertsProject) {
  const Camera c = freiburg1();
  const Eigen::Vector3d p(0.4, -0.3, 2.5);
  EXPECT_LT((c.unproject(c.project(p), p.z()) - p).norm(), 1e-14);
  EXPECT_EQ(c.project({0.0, 0.0, 3.0}), Eigen::Vector2d(c.cx, c.cy));
}

TEST(Camera, DistortInvertsUndistortOverTheImage) {
  const Camera c = freiburg1();
  for (int y = 0; y < c.height; y += 40) {
    for (int x = 0; x < c.width; x += 40) {
      const Eigen::Vector2d raw(x, y);
      EXPECT_LT((c.distort(c.undistort(raw)) - raw).norm(), 1e-6) << raw.transpose();
    }
  }
}

TEST(Camera, DistortsByTheRadialTangentialModel) {
  const Camera c = freiburg1();
  const double x = 0.3;
  const double y = -0.2;
  const double r2 = x * x + y * y;
  const double radial = 1.0 + c.k1 * r2 + c.k2 * r2 * r2 + c.k3 * r2 * r2 * r2;
  const double xd = x * radial + 2.0 * c.p1 * x * y + c.p2 * (r2 + 2.0 * x * x);
  const double yd = y * radial + c.p1 * (r2 + 2.0 * y * y) + 2.0 * c.p2 * x * y;
  const Eigen::Vector2d raw = c.distort({c.fx * x + c.cx, c.fy * y + c.cy});
  EXPECT_NEAR(raw.x(), c.fx * xd + c.cx, 1e-10);
  EXPECT_NEAR(raw.y(), c.fy * yd + c.cy, 1e-10);
}

TEST(Camera, LeavesPixelsAloneWithoutDistortion) {
  Camera c = freiburg1();
  c.k1 = c.k2 = c.p1 = c.p2 = c.k3 = 0.0;
  const Eigen::Vector2d pixel(12.5, 400.25);
  EXPECT_FALSE(c.has_distortion());
  EXPECT_EQ(c.undistort(pixel), pixel);
  EXPECT_EQ(c.distort(pixel), pixel);
}

TEST(Camera, ContainsPixelCentresOnly) {
  const Camera c = freiburg1();
  EXPECT_TRUE(c.contains({0.0, 0.0}));
  EXPECT_TRUE(c.contains({639.0, 479.0}));
  EXPECT_FALSE(c.contains({639.5, 10.0}));
  EXPECT_FALSE(c.contains({-0.1, 10.0}));
  EXPECT_FALSE(c.contains({10.0, std::nan("")}));
}

TEST(Camera, AcceptsARealCalibration) { EXPECT_NO_THROW(freiburg1().validate("calib.yaml")); }

TEST(Camera, NamesPlaceFieldAndBoundsOfABadValue) {
  Camera c = freiburg1();
  c.fx = -1.0;
  EXPECT_THAT(refusal(c), AllOf(HasSubstr("calib.yaml"), HasSubstr("fx"), HasSubstr("-1")));
  c = freiburg1();
  c.cy = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(refusal(c), HasSubstr("cy"));
  c = freiburg1();
  c.width = 0;
  EXPECT_THAT(refusal(c), HasSubstr("width"));
  c = freiburg1();
  c.k3 = std::numeric_limits<double>::infinity();
  EXPECT_THAT(refusal(c), HasSubstr("distortion"));
  c = freiburg1();
  c.depth_factor = 0.0;
  EXPECT_THAT(refusal(c), HasSubstr("depth_factor"));
}

}  // namespace
}  // namespace dxslam
