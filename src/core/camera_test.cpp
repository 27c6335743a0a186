// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "core/camera.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/rig.h"

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
  c.lens.parameters = {0.262383, -0.953104, -0.005358, 0.002628, 1.163314};
  return c;
}

Camera barrel_lens() {
  Camera c = freiburg1();
  c.fx = c.fy = 400.0;
  c.lens.parameters = {-0.1};
  return c;
}

std::string refusal(Camera camera) {
  try {
    camera.prepare("calib.yaml");
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

TEST(Camera, MeasuresHowFarAPointAppearsFromAPixel) {
  const Camera c = freiburg1();
  EXPECT_NEAR(c.squared_error({0.0, 0.0, 3.0}, {c.cx + 3.0, c.cy - 4.0}), 25.0, 1e-12);
  EXPECT_TRUE(std::isinf(c.squared_error({0.0, 0.0, 0.0}, {c.cx, c.cy})));
  EXPECT_TRUE(std::isinf(c.squared_error({0.0, 0.0, -3.0}, {c.cx, c.cy})));
}

TEST(Camera, DistortInvertsUndistortOverTheImage) {
  const Camera c = freiburg1();
  for (int y = 0; y < c.height; y += 40) {
    for (int x = 0; x < c.width; x += 40) {
      const Eigen::Vector2d raw(x, y);
      EXPECT_LT((c.distort(*c.undistort(raw)) - raw).norm(), 1e-6) << raw.transpose();
    }
  }
}

TEST(Camera, DistortsByTheRadialTangentialModel) {
  const Camera c = freiburg1();
  const double x = 0.3;
  const double y = -0.2;
  const double r2 = x * x + y * y;
  const auto [k1, k2, p1, p2, k3, none1, none2, none3] = c.lens.parameters;
  const double radial = 1.0 + k1 * r2 + k2 * r2 * r2 + k3 * r2 * r2 * r2;
  const double xd = x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x);
  const double yd = y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y;
  const Eigen::Vector2d raw = c.distort({c.fx * x + c.cx, c.fy * y + c.cy});
  EXPECT_NEAR(raw.x(), c.fx * xd + c.cx, 1e-10);
  EXPECT_NEAR(raw.y(), c.fy * yd + c.cy, 1e-10);
}

TEST(Camera, LeavesPixelsAloneWithoutDistortion) {
  Camera c = freiburg1();
  c.lens = Lens();
  const Eigen::Vector2d pixel(12.5, 400.25);
  EXPECT_FALSE(c.has_distortion());
  EXPECT_EQ(c.undistort(pixel), pixel);
  EXPECT_EQ(c.distort(pixel), pixel);
}

TEST(Camera, ContainsPixelCentresOnly) {
  Camera c = freiburg1();
  c.lens = Lens();
  EXPECT_TRUE(c.contains({0.0, 0.0}));
  EXPECT_TRUE(c.contains({639.0, 479.0}));
  EXPECT_FALSE(c.contains({639.5, 10.0}));
  EXPECT_FALSE(c.contains({-0.1, 10.0}));
  EXPECT_FALSE(c.contains({10.0, std::nan("")}));
}

// The edge of a barrel lens's image lies outside of the raw rectangle once it is undistorted.
TEST(Camera, ContainsTheUndistortedImageOfALens) {
  Camera c = barrel_lens();
  c.prepare("calib.yaml");
  for (int i = 0; i <= 100; ++i) {
    for (const Eigen::Vector2d& raw :
         {Eigen::Vector2d(6.39 * i, 0.0), Eigen::Vector2d(6.39 * i, 479.0),
          Eigen::Vector2d(0.0, 4.79 * i), Eigen::Vector2d(639.0, 4.79 * i)}) {
      const Eigen::Vector2d pixel = c.undistort(raw).value();
      EXPECT_LT((c.distort(pixel) - raw).norm(), 1e-6) << raw.transpose();
      const Eigen::Vector2d inwards = Eigen::Vector2d(c.cx, c.cy) - pixel;
      EXPECT_TRUE(c.contains(pixel + 1e-3 * inwards)) << raw.transpose();
    }
  }
  EXPECT_LT(c.view().left, -30.0);
  EXPECT_FALSE(c.contains({c.view().left - 1.0, 200.0}));
  EXPECT_TRUE(c.project_into_view(c.unproject(*c.undistort({1.0, 240.0}), 2.0)).has_value());
}

TEST(Camera, RefusesALensThatFoldsTheImage) {
  Camera c = barrel_lens();
  c.lens.parameters[0] = -0.6;
  EXPECT_THAT(refusal(c), AllOf(HasSubstr("calib.yaml: the distortion (radtan) k1 -0.6"),
                                HasSubstr("cannot be undone at pixel (0, 0)")));
  c.lens.parameters[0] =
      30.0;  // so strong that a pixel is a tenth of its area: still one direction a pixel
  EXPECT_EQ(refusal(c), "");
  c.lens.parameters = {-0.1, 0.0, 5.0};
  EXPECT_THAT(refusal(c), HasSubstr("cannot be undone"));
}

TEST(PixelBox, PutsEveryPixelIntoOneOfItsCells) {
  const PixelBox box{-10.0, 0.0, 29.0, 19.0};
  EXPECT_EQ(box.cell_of({-10.0F, 0.0F}, 4, 2), 0U);
  EXPECT_EQ(box.cell_of({29.0F, 19.0F}, 4, 2), 7U);
  EXPECT_EQ(box.cell_of({5.0F, 12.0F}, 4, 2), 5U);
  const float infinity = std::numeric_limits<float>::infinity();
  EXPECT_EQ(box.cell_of({-infinity, 1e30F}, 4, 2), 4U);
  EXPECT_EQ(box.cell_of({std::nanf(""), std::nanf("")}, 4, 2), 0U);
}

// How fast images come says nothing about what is in them: two recordings, one camera.
TEST(Rig, KnowsACameraWhateverItsRate) {
  Camera camera = freiburg1();
  Rig rig(camera);
  camera.fps = 29.97;
  camera.max_depth = 4.0;
  EXPECT_EQ(rig.add(camera), 0U);
  camera.fx += 0.1;
  EXPECT_EQ(rig.add(camera), 1U);
  EXPECT_THROW(static_cast<void>(rig[2]), ContractError);
}

TEST(Camera, AcceptsARealCalibration) { EXPECT_EQ(refusal(freiburg1()), ""); }

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
  c.lens.parameters[4] = std::numeric_limits<double>::infinity();
  EXPECT_THAT(refusal(c), HasSubstr("k3"));
  c = freiburg1();
  c.depth_factor = 0.0;
  EXPECT_THAT(refusal(c), HasSubstr("depth_factor"));
  c = freiburg1();
  c.fps = 15.0;
  c.readout_time = 0.0667;  // all of 1/15 s
  EXPECT_EQ(refusal(c), "");
  c.readout_time = 0.1;
  EXPECT_THAT(refusal(c), HasSubstr("readout_time is 0.1 s, expected at most the 0.06667 s"));
}

}  // namespace
}  // namespace dxslam
