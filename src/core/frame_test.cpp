// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "core/frame.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/error.h"

namespace dxslam {
namespace {

class FrameTest : public testing::Test {
 protected:
  FrameTest() {
    camera_.width = 64;
    camera_.height = 48;
    camera_.fx = camera_.fy = 60.0;
    camera_.cx = 31.5;
    camera_.cy = 23.5;
    image_.index = 7;
    image_.stamp = 1.5;
    image_.depth = cv::Mat(48, 64, CV_32FC1, cv::Scalar(2.0));
  }

  float depth_at(float x, float y) {
    Features features;
    features.keypoints.push_back({x, y, 0.5F, 1.2F});
    features.descriptors = cv::Mat::zeros(1, 32, CV_32FC1);
    return make_frame(image_, features, camera_)->depths.at(0);
  }

  Camera camera_;
  RgbdImage image_;
};

TEST_F(FrameTest, CarriesWhatTheExtractorSaid) {
  Features features;
  features.keypoints = {{10.0F, 20.0F, 0.9F, 1.0F}, {30.0F, 5.0F, 0.4F, 2.0F}};
  features.descriptors = cv::Mat::ones(2, 8, CV_8UC1);
  features.global = {0.6F, 0.8F};
  const FramePtr frame = make_frame(image_, features, camera_);
  ASSERT_EQ(frame->size(), 2U);
  EXPECT_EQ(frame->index, 7);
  EXPECT_EQ(frame->stamp, 1.5);
  EXPECT_EQ(frame->pixels[1], Eigen::Vector2f(30.0F, 5.0F));
  EXPECT_EQ(frame->scores[0], 0.9F);
  EXPECT_EQ(frame->sigmas[1], 2.0F);
  EXPECT_EQ(frame->descriptors.rows, 2);
  EXPECT_EQ(frame->global, features.global);
  EXPECT_TRUE(frame->has_depth(0));
}

TEST_F(FrameTest, RefusesImagesOfAnotherSize) {
  const Features none;
  image_.color = cv::Mat::zeros(48, 64, CV_8UC3);
  EXPECT_NO_THROW(make_frame(image_, none, camera_));
  image_.color = cv::Mat::zeros(48, 32, CV_8UC3);
  EXPECT_THROW(make_frame(image_, none, camera_), ContractError);
  image_.color = cv::Mat();
  image_.depth = cv::Mat::zeros(24, 64, CV_32FC1);
  EXPECT_THROW(make_frame(image_, none, camera_), ContractError);
}

TEST_F(FrameTest, TakesReadingsTooNearAsMissing) {
  image_.depth.at<float>(10, 10) = 1e-6F;
  EXPECT_EQ(depth_at(10.0F, 10.0F), 0.0F);
}

TEST_F(FrameTest, UndistortsPixelsButReadsDepthAtTheRawOnes) {
  camera_.lens.parameters[0] = 0.5;
  image_.depth.at<float>(2, 3) = 1.0F;
  Features features;
  features.keypoints.push_back({3.0F, 2.0F, 1.0F, 1.0F});
  features.descriptors = cv::Mat::zeros(1, 4, CV_32FC1);
  const FramePtr frame = make_frame(image_, features, camera_);
  const Eigen::Vector2d expected = camera_.undistort({3.0, 2.0}).value();
  EXPECT_LT((frame->pixels[0].cast<double>() - expected).norm(), 1e-4);
  EXPECT_EQ(frame->depths[0], 1.0F);
}

TEST_F(FrameTest, InterpolatesDisparityOnASurface) {
  image_.depth.at<float>(10, 10) = 2.00F;
  image_.depth.at<float>(10, 11) = 2.02F;
  image_.depth.at<float>(11, 10) = 2.00F;
  image_.depth.at<float>(11, 11) = 2.02F;
  const float expected = 1.0F / (0.75F / 2.00F + 0.25F / 2.02F);
  EXPECT_NEAR(depth_at(10.25F, 10.5F), expected, 1e-6F);
}

TEST_F(FrameTest, InventsNoDepthAcrossAnEdge) {
  image_.depth.at<float>(10, 11) = 4.0F;
  EXPECT_EQ(depth_at(10.3F, 10.0F), 2.0F);
  EXPECT_EQ(depth_at(10.7F, 10.0F), 4.0F);
  image_.depth.at<float>(11, 11) = 0.0F;
  EXPECT_EQ(depth_at(10.3F, 10.3F), 2.0F);
}

TEST_F(FrameTest, TreatsMissingAndUnusableReadingsAsNone) {
  image_.depth.at<float>(10, 10) = 0.0F;
  EXPECT_EQ(depth_at(10.0F, 10.0F), 0.0F);
  image_.depth.at<float>(10, 10) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(depth_at(10.0F, 10.0F), 0.0F);
  image_.depth.at<float>(10, 10) = static_cast<float>(camera_.max_depth) + 1.0F;
  EXPECT_EQ(depth_at(10.0F, 10.0F), 0.0F);
  EXPECT_EQ(depth_at(-1.0F, 10.0F), 0.0F);
  EXPECT_EQ(depth_at(64.0F, 10.0F), 0.0F);
}

TEST_F(FrameTest, ReadsTheLastRowAndColumn) { EXPECT_EQ(depth_at(63.0F, 47.0F), 2.0F); }

TEST_F(FrameTest, WorksWithoutADepthImage) {
  image_.depth = cv::Mat();
  EXPECT_EQ(depth_at(10.0F, 10.0F), 0.0F);
}

TEST_F(FrameTest, RefusesPartsThatDoNotFit) {
  Features features;
  features.keypoints.resize(2);
  features.descriptors = cv::Mat::zeros(1, 4, CV_32FC1);
  EXPECT_THROW(make_frame(image_, features, camera_), ContractError);
  features.descriptors = cv::Mat::zeros(2, 4, CV_64FC1);
  EXPECT_THROW(make_frame(image_, features, camera_), ContractError);
  features.descriptors = cv::Mat::zeros(2, 4, CV_32FC1);
  EXPECT_NO_THROW(make_frame(image_, features, camera_));
  image_.depth = cv::Mat::zeros(48, 64, CV_16UC1);
  EXPECT_THROW(make_frame(image_, features, camera_), ContractError);
  image_.depth = cv::Mat::zeros(24, 32, CV_32FC1);
  EXPECT_THROW(make_frame(image_, features, camera_), ContractError);
}

TEST_F(FrameTest, AcceptsAnImageWithoutKeypoints) {
  EXPECT_EQ(make_frame(image_, Features(), camera_)->size(), 0U);
}

TEST(MeasurementOfAPoint, HasItsDisparityOrNone) {
  Camera camera;
  camera.fx = 500.0;
  Frame frame;
  frame.depths = {2.0F, 3.0F, 0.0F};
  frame.sigmas = {1.0F, 1.0F, 1.0F};
  frame.pixels.resize(3, {4.0F, 5.0F});
  EXPECT_NEAR(measurement_of(frame, 0, camera, 2.0).disparity, camera.bf() / 2.0, 1e-9);
  EXPECT_EQ(measurement_of(frame, 0, camera).pixel, Eigen::Vector2d(4.0, 5.0));
  EXPECT_FALSE(measurement_of(frame, 2, camera).has_disparity());
  EXPECT_GT(measurement_of(frame, 0, camera, 2.02).disparity, 0.0);
  EXPECT_EQ(measurement_of(frame, 1, camera, 2.0).disparity, 0.0)
      << "of a surface behind the point";
  EXPECT_EQ(measurement_of(frame, 2, camera, 2.0).disparity, 0.0) << "without a reading";
  EXPECT_EQ(measurement_of(frame, 0, camera, -2.0).disparity, 0.0) << "behind the camera";
}

}  // namespace
}  // namespace dxslam
