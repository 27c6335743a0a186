// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/recordings/depth_registration.h"

#include <gtest/gtest.h>

#include "core/error.h"

namespace dxslam {
namespace {

Camera color_camera() {
  Camera camera;
  camera.width = 160;
  camera.height = 120;
  camera.fx = camera.fy = 130.0;
  camera.cx = 80.0;
  camera.cy = 60.0;
  camera.depth_factor = 1000.0;
  return camera;
}

DepthCamera depth_camera() {
  DepthCamera depth;
  depth.fx = depth.fy = 145.0;
  depth.cx = 78.0;
  depth.cy = 61.0;
  depth.x = -0.025;
  depth.y = 0.005;
  depth.z = 0.003;
  depth.rx = 0.007;
  depth.ry = -0.004;
  depth.rz = 0.0086;
  return depth;
}

cv::Mat no_depth(const Camera& camera) {
  return cv::Mat(camera.height, camera.width, CV_16UC1, cv::Scalar(0));
}

TEST(DepthRegistration, PutsReadingsWhereTheColourCameraSeesThem) {
  Camera color = color_camera();
  for (const double k1 : {0.0, 0.2}) {
    color.lens.parameters[0] = k1;
    color.prepare("test");
    const DepthCamera depth = depth_camera();
    const DepthRegistration registration(color, depth);
    for (const cv::Point at : {cv::Point(20, 30), cv::Point(80, 60), cv::Point(130, 100)}) {
      cv::Mat raw = no_depth(color);
      raw.at<std::uint16_t>(at) = 1500;
      const Eigen::Vector3d in_depth((at.x - depth.cx) / depth.fx * 1.5,
                                     (at.y - depth.cy) / depth.fy * 1.5, 1.5);
      const Eigen::Vector3d in_color = depth.color_from_depth() * in_depth;
      const Eigen::Vector2d pixel = color.distort(color.project(in_color));
      const cv::Mat registered = registration(raw);
      EXPECT_EQ(cv::countNonZero(registered), 1);
      const cv::Point nearest(static_cast<int>(std::lround(pixel.x())),
                              static_cast<int>(std::lround(pixel.y())));
      EXPECT_NEAR(registered.at<std::uint16_t>(nearest), 1000.0 * in_color.z(), 0.51) << at;
    }
  }
}

TEST(DepthRegistration, KnowsSizeAndLensOfTheDepthCamera) {
  const Camera color = color_camera();
  DepthCamera depth = depth_camera();
  depth.width = 200;
  depth.height = 90;
  depth.lens.parameters[0] = -0.25;
  const DepthRegistration registration(color, depth);
  ASSERT_EQ(registration.raw_size(), cv::Size(200, 90));
  const Eigen::Vector2d ideal(-0.45, 0.15);
  const Eigen::Vector2d place =
      depth.lens.model->distort(depth.lens.parameters, ideal, nullptr) * depth.fx +
      Eigen::Vector2d(depth.cx, depth.cy);
  cv::Mat raw(90, 200, CV_16UC1, cv::Scalar(0));
  raw.at<std::uint16_t>(static_cast<int>(std::lround(place.y())),
                        static_cast<int>(std::lround(place.x()))) = 1500;
  const Eigen::Vector3d in_color = depth.color_from_depth() * (1.5 * ideal.homogeneous());
  const Eigen::Vector2d pixel = color.project(in_color);
  const cv::Mat registered = registration(raw);
  ASSERT_EQ(registered.size(), cv::Size(color.width, color.height));
  // Rounded twice, so a neighbour may have it; without the lens it would be 4 pixels off.
  const cv::Rect around(static_cast<int>(std::lround(pixel.x())) - 1,
                        static_cast<int>(std::lround(pixel.y())) - 1, 3, 3);
  EXPECT_EQ(cv::countNonZero(registered), 1);
  EXPECT_EQ(cv::countNonZero(registered(around)), 1);
}

TEST(DepthRegistration, KeepsTheNearestWhereSeveralMeet) {
  const Camera color = color_camera();
  DepthCamera depth = depth_camera();
  depth.fx = depth.fy = color.fx;
  depth.cx = color.cx;
  depth.cy = color.cy;
  depth.y = depth.z = depth.rx = depth.ry = depth.rz = 0.0;
  depth.x = -0.1;
  // 130 * 0.1 / 1 = 13 pixels to the left at 1 m, 130 * 0.1 / 2 = 6.5 at 2 m, 3.25 at 4 m.
  for (const bool near_first : {true, false}) {
    cv::Mat raw = no_depth(color);
    const int far_x = 50;
    const int near_x = far_x - 3 + 13;
    raw.at<std::uint16_t>(40, near_x) = 1000;
    raw.at<std::uint16_t>(40, far_x) = 4000;
    if (!near_first) raw.at<std::uint16_t>(40, near_x - 13 + 6) = 2100;
    const cv::Mat registered = DepthRegistration(color, depth)(raw);
    EXPECT_EQ(registered.at<std::uint16_t>(40, far_x - 3), 1000);
  }
}

TEST(DepthRegistration, LeavesNoHolesInAWallWhereColourHasMorePixels) {
  Camera color = color_camera();
  color.fx = color.fy = 260.0;
  const DepthCamera depth = depth_camera();
  const cv::Mat wall(color.height, color.width, CV_16UC1, cv::Scalar(2000));
  const cv::Mat registered = DepthRegistration(color, depth)(wall);
  EXPECT_EQ(cv::countNonZero(registered), static_cast<int>(registered.total()));
}

TEST(DepthRegistration, LeavesOutInvalidReadingsAndWhatIsBehindTheCamera) {
  const Camera color = color_camera();
  DepthCamera depth = depth_camera();
  const cv::Mat invalid(color.height, color.width, CV_16UC1, cv::Scalar(65535));
  EXPECT_EQ(cv::countNonZero(DepthRegistration(color, depth)(invalid)), 0);
  depth.z = -3.0;
  const cv::Mat wall(color.height, color.width, CV_16UC1, cv::Scalar(2000));
  EXPECT_EQ(cv::countNonZero(DepthRegistration(color, depth)(wall)), 0);
}

TEST(DepthRegistration, RefusesADepthCameraWithoutFocalLength) {
  EXPECT_THROW(DepthRegistration(color_camera(), DepthCamera()), ContractError);
  EXPECT_THROW(DepthRegistration(color_camera(), depth_camera())(cv::Mat(10, 10, CV_16UC1)),
               ContractError);
}

}  // namespace
}  // namespace dxslam
