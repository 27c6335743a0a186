// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "synthetic/texture.h"

#include <gtest/gtest.h>

#include "core/error.h"

namespace dxslam {
namespace {

cv::Mat checkerboard(int side, int cell) {
  cv::Mat image(side, side, CV_8UC3);
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const uchar value = (x / cell + y / cell) % 2 == 0 ? 20 : 220;
      image.at<cv::Vec3b>(y, x) = {value, value, value};
    }
  }
  return image;
}

TEST(Texture, PlainPictureStaysPlainAtEveryScale) {
  const Texture texture(cv::Mat(64, 128, CV_8UC3, cv::Scalar(10, 120, 250)));
  for (const float step : {0.0001F, 0.01F, 0.1F, 0.7F}) {
    for (const float u : {-0.3F, 0.0F, 0.51F, 0.99F}) {
      float bgr[3];
      texture.sample(u, 0.37F, step, 0.001F, 0.0F, step / 3, u < 0.0F, bgr);
      EXPECT_NEAR(bgr[0], 10, 0.5);
      EXPECT_NEAR(bgr[1], 120, 0.5);
      EXPECT_NEAR(bgr[2], 250, 0.5);
    }
  }
}

TEST(Texture, InterpolatesBetweenTexelCentres) {
  cv::Mat image(2, 2, CV_8UC3, cv::Scalar(0, 0, 0));
  image.at<cv::Vec3b>(0, 1) = image.at<cv::Vec3b>(1, 1) = {200, 100, 40};
  const Texture texture(image);
  float bgr[3];
  texture.sample(0.25F, 0.5F, 1e-4F, 0, 0, 1e-4F, false, bgr);
  EXPECT_NEAR(bgr[0], 0, 1);
  texture.sample(0.5F, 0.5F, 1e-4F, 0, 0, 1e-4F, false, bgr);
  EXPECT_NEAR(bgr[0], 100, 1);
  EXPECT_NEAR(bgr[1], 50, 1);
  EXPECT_NEAR(bgr[2], 20, 1);
}

TEST(Texture, WideFootprintSeesTheMean) {
  const Texture texture(checkerboard(256, 2));
  for (const float u : {0.301F, 0.4037F, 0.55F}) {
    float bgr[3];
    texture.sample(u, 0.5F, 0.1F, 0, 0, 0.1F, true, bgr);
    EXPECT_NEAR(bgr[0], 120, 4) << "at " << u;
  }
}

TEST(Texture, LongFootprintKeepsDetailAcrossIt) {
  // Stripes along v: a footprint that is long in v only must still tell them apart.
  cv::Mat stripes(256, 256, CV_8UC3);
  for (int x = 0; x < 256; ++x) stripes.col(x).setTo(cv::Scalar::all(x / 8 % 2 == 0 ? 20 : 220));
  const Texture texture(stripes);
  float dark[3], light[3];
  texture.sample(4.0F / 256, 0.5F, 1.0F / 256, 0, 0, 4.0F / 256, true, dark);
  texture.sample(12.0F / 256, 0.5F, 1.0F / 256, 0, 0, 4.0F / 256, true, light);
  EXPECT_LT(dark[0], 30);
  EXPECT_GT(light[0], 210);
}

TEST(Texture, WrapsOnlyWhereTiled) {
  cv::Mat image(4, 4, CV_8UC3, cv::Scalar::all(0));
  image.col(0).setTo(cv::Scalar::all(240));
  const Texture texture(image);
  float bgr[3];
  texture.sample(1.0F, 0.5F, 1e-4F, 0, 0, 1e-4F, true, bgr);
  EXPECT_NEAR(bgr[0], 120, 2);
  texture.sample(1.0F, 0.5F, 1e-4F, 0, 0, 1e-4F, false, bgr);
  EXPECT_NEAR(bgr[0], 0, 1);
}

TEST(Texture, RefusesPicturesItCannotHalve) {
  EXPECT_THROW(Texture(cv::Mat(48, 64, CV_8UC3)), ContractError);
  EXPECT_THROW(Texture(cv::Mat(64, 64, CV_8UC1)), ContractError);
}

}  // namespace
}  // namespace dxslam
