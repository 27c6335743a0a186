// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "features/network/pixel_blocks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/error.h"
#include "core/test_simd.h"
#include "features/network/test_models.h"

namespace dxslam {
namespace {

using testing_support::simd_levels;
using testing_support::test_image;

TEST(PixelBlocks, StatisticsEqualThoseOfOpenCv) {
  for (const cv::Size size : {cv::Size(64, 48), cv::Size(101, 7), cv::Size(640, 480)}) {
    const cv::Mat image = test_image(size.width, size.height, 1);
    cv::Scalar mean;
    cv::Scalar deviation;
    cv::meanStdDev(image, mean, deviation);
    for (const SimdLevel level : simd_levels()) {
      set_simd_level(level);
      const PixelStatistics found = pixel_statistics(image);
      EXPECT_NEAR(found.mean, mean[0], 1e-9);
      EXPECT_NEAR(found.deviation, deviation[0], 1e-7);
    }
  }
  EXPECT_EQ(pixel_statistics(cv::Mat(32, 32, CV_8U, cv::Scalar(77))).deviation, 0.0);
}

TEST(PixelBlocks, KeepEachPixelInItsPlaceAndChannel) {
  const cv::Mat image = test_image(96, 60, 2);
  for (const SimdLevel level : simd_levels()) {
    set_simd_level(level);
    for (const int block : {4, 2, 3}) {
      cv::Mat blocks;
      pixels_to_blocks(image, block, 0.5F, -20.0F, CV_32F, blocks);
      ASSERT_EQ(blocks.size(), cv::Size(96 / block, 60 / block));
      ASSERT_EQ(blocks.channels(), block * block);
      for (int y = 0; y < image.rows; ++y) {
        for (int x = 0; x < image.cols; ++x) {
          const int channel = (y % block) * block + x % block;
          const float found = blocks.ptr<float>(y / block, x / block)[channel];
          ASSERT_EQ(found, static_cast<float>(image.at<std::uint8_t>(y, x)) * 0.5F - 20.0F);
        }
      }
    }
  }
}

TEST(PixelBlocks, RoundAndSaturateIntegers) {
  cv::Mat image(8, 256, CV_8U);
  for (int x = 0; x < 256; ++x) image.col(x).setTo(x);
  for (const SimdLevel level : simd_levels()) {
    set_simd_level(level);
    cv::Mat blocks;
    pixels_to_blocks(image, 4, 1.371F, -170.23F, CV_8S, blocks);
    for (int x = 0; x < 256; ++x) {
      const double exact = std::clamp(std::nearbyint(x * 1.371F - 170.23F), -127.0F, 127.0F);
      const int found = blocks.ptr<std::int8_t>(1, x / 4)[4 + x % 4];
      EXPECT_NEAR(found, exact, 0.0) << x;
    }
  }
}

TEST(PixelBlocks, RefuseWhatIsNotOfWholeBlocks) {
  cv::Mat out;
  EXPECT_THROW(pixels_to_blocks(test_image(30, 32, 3), 4, 1, 0, CV_32F, out), ContractError);
  EXPECT_THROW(pixels_to_blocks(test_image(32, 32, 3), 4, 1, 0, CV_16S, out), ContractError);
  EXPECT_THROW(pixels_to_blocks(cv::Mat(32, 32, CV_8UC3), 4, 1, 0, CV_32F, out), ContractError);
}

}  // namespace
}  // namespace dxslam
