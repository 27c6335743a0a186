// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "synthetic/patterns.h"

#include <gtest/gtest.h>

#include "synthetic/brush.h"

namespace dxslam {
namespace {

class EveryPattern : public testing::TestWithParam<int> {};

TEST_P(EveryPattern, FollowsItsSeedAndHasContrast) {
  const auto pattern = static_cast<Pattern>(GetParam());
  const cv::Size size(256, 256);
  const cv::Mat first = paint_pattern(pattern, 5, size), again = paint_pattern(pattern, 5, size);
  const cv::Mat other = paint_pattern(pattern, 6, size);
  ASSERT_EQ(first.type(), CV_8UC3);
  ASSERT_EQ(first.size(), size);
  EXPECT_EQ(cv::norm(first, again, cv::NORM_L1), 0.0);
  EXPECT_GT(cv::norm(first, other, cv::NORM_L1), 0.0);
  cv::Scalar mean, deviation;
  cv::meanStdDev(first, mean, deviation);
  EXPECT_GT(deviation[0] + deviation[1] + deviation[2], 10.0);
}

INSTANTIATE_TEST_SUITE_P(All, EveryPattern,
                         testing::Range(0, static_cast<int>(Pattern::kFace) + 1));

TEST(FractalNoise, FitsAtOppositeBorders) {
  Random random(3);
  const cv::Mat noise = brush::fractal_noise(random, {256, 128}, 4, 4, 3);
  double across = 0.0, within = 0.0;
  for (int y = 0; y < noise.rows; ++y) {
    across += std::abs(noise.at<float>(y, 0) - noise.at<float>(y, 255));
    within += std::abs(noise.at<float>(y, 100) - noise.at<float>(y, 101));
  }
  EXPECT_LT(across, 3.0 * within);
}

}  // namespace
}  // namespace dxslam
