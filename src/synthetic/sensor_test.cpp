// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "synthetic/sensor.h"

#include <gtest/gtest.h>

#include <cmath>

#include "synthetic/test_worlds.h"

namespace dxslam {
namespace {

// A wall across the view, seen squarely.
Rendering wall_at(double z, double cosine = 1.0) {
  const Camera camera = testing_worlds::small_camera();
  Rendering r;
  r.depth = cv::Mat(camera.height, camera.width, CV_32FC1, cv::Scalar(z));
  r.incidence = cv::Mat(camera.height, camera.width, CV_32FC1, cv::Scalar(cosine));
  return r;
}

double deviation_at(double z) {
  const cv::Mat depth = measure_depth(wall_at(z), testing_worlds::small_camera(), 1.0, 7);
  cv::Scalar mean, deviation;
  cv::meanStdDev(depth, mean, deviation, depth > 0);
  EXPECT_NEAR(mean[0], z, 0.01 * z);
  return deviation[0];
}

TEST(DepthSensor, IsExactToTheMillimetreWithoutNoise) {
  const cv::Mat depth = measure_depth(wall_at(2.3456), testing_worlds::small_camera(), 0.0, 7);
  EXPECT_EQ(cv::countNonZero(cv::abs(depth - 2.346F) > 1e-5), 0);
}

TEST(DepthSensor, NoiseGrowsWithTheSquareOfTheDepth) {
  const double near = deviation_at(1.0), far = deviation_at(4.0);
  EXPECT_GT(near, 0.001);
  EXPECT_LT(near, 0.005);
  EXPECT_NEAR(far / near, 16.0, 4.0);
}

TEST(DepthSensor, HasARangeAndDislikesGrazingSurfaces) {
  const Camera camera = testing_worlds::small_camera();
  EXPECT_EQ(cv::countNonZero(measure_depth(wall_at(0.3), camera, 1.0, 1)), 0);
  EXPECT_EQ(cv::countNonZero(measure_depth(wall_at(8.1), camera, 1.0, 1)), 0);
  EXPECT_EQ(cv::countNonZero(measure_depth(wall_at(2.0, 0.05), camera, 1.0, 1)), 0);
  EXPECT_GT(cv::countNonZero(measure_depth(wall_at(2.0), camera, 1.0, 1)), 0.99 * 160 * 120);
}

TEST(DepthSensor, LeavesAShadowOnOneSideOfNearThings) {
  Rendering r = wall_at(3.0);
  r.depth(cv::Rect(60, 40, 40, 40)).setTo(0.8F);
  const cv::Mat depth = measure_depth(r, testing_worlds::small_camera(), 1.0, 1);
  // 130 px * 0.075 m * (1/0.8 - 1/3) = 8.9 pixels.
  const int left = cv::countNonZero(depth(cv::Rect(52, 45, 7, 30)));
  const int right = cv::countNonZero(depth(cv::Rect(101, 45, 7, 30)));
  EXPECT_LT(left, 7 * 30 / 20);
  EXPECT_GT(right, 7 * 30 * 9 / 10);
}

TEST(ImageSensor, EncodesWithGammaAndClips) {
  cv::Mat radiance(4, 4, CV_32FC3, cv::Scalar(1.7, std::pow(0.6, 2.2), 0.0));
  const cv::Mat image = develop_image(radiance, 1.0, 0.0, 1);
  EXPECT_EQ(image.at<cv::Vec3b>(2, 2), cv::Vec3b(255, 153, 0));
}

TEST(ImageSensor, NoiseHasTheStatedStrengthAndFollowsItsSeed) {
  const cv::Mat radiance(120, 160, CV_32FC3, cv::Scalar(0.2, 0.2, 0.2));
  const cv::Mat image = develop_image(radiance, 1.0, 2.0, 1);
  cv::Scalar mean, deviation;
  cv::meanStdDev(image, mean, deviation);
  EXPECT_NEAR(deviation[0], 3.0, 0.15);
  EXPECT_EQ(cv::norm(image, develop_image(radiance, 1.0, 2.0, 1), cv::NORM_L1), 0.0);
  EXPECT_GT(cv::norm(image, develop_image(radiance, 1.0, 2.0, 2), cv::NORM_L1), 0.0);
}

}  // namespace
}  // namespace dxslam
