// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "synthetic/low_light.h"

#include <cmath>
#include <numeric>
#include <random>

#include "io/primitives/test_folder.h"

namespace dxslam {
namespace {

// The model as it is written down, one draw at a time.
int darken(int value, double gain, std::mt19937& random) {
  double x = gain * std::pow(value / 255.0, 2.2);
  x = std::poisson_distribution<int>(std::max(x * 400.0, 1e-300))(random) / 400.0 +
      std::normal_distribution<double>(0.0, 0.006)(random);
  return static_cast<int>(std::clamp(x * 255.0, 0.0, 255.0));
}

TEST(LowLight, DistributionIsThatOfTheModel) {
  std::mt19937 random(5);
  constexpr int kDraws = 40000;
  for (const double gain : {0.06, 1.0}) {
    for (const int level : {0, 60, 140, 255}) {
      const auto expected = LowLight::distribution(level, gain);
      EXPECT_NEAR(std::accumulate(expected.begin(), expected.end(), 0.0), 1.0, 1e-9);
      std::array<double, 256> seen{};
      for (int i = 0; i < kDraws; ++i) {
        seen[static_cast<std::size_t>(darken(level, gain, random))] += 1.0 / kDraws;
      }
      double expected_below = 0.0;
      double seen_below = 0.0;
      double largest = 0.0;
      for (std::size_t j = 0; j < 256; ++j) {
        expected_below += expected[j];
        seen_below += seen[j];
        largest = std::max(largest, std::abs(expected_below - seen_below));
      }
      // Kolmogorov and Smirnov's 99.9 % quantile is 1.95 / sqrt(n).
      EXPECT_LT(largest, 1.95 / std::sqrt(kDraws)) << "gain " << gain << ", level " << level;
    }
  }
}

TEST(LowLight, ImagesFollowTheDistribution) {
  const LowLight model(0.12);
  constexpr int kSide = 400;
  for (const int level : {0, 128, 255}) {
    const cv::Mat flat(kSide, kSide, CV_8UC1, cv::Scalar(level));
    const cv::Mat dark = model.apply(flat, 3);
    const auto expected = LowLight::distribution(level, 0.12);
    std::array<double, 256> seen{};
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x) seen[dark.at<std::uint8_t>(y, x)] += 1.0 / (kSide * kSide);
    }
    for (std::size_t j = 0; j < 256; ++j) {
      const double sigma = std::sqrt(expected[j] / (kSide * kSide));
      EXPECT_NEAR(seen[j], expected[j], 5.0 * sigma + 1e-5) << "level " << level << " to " << j;
    }
  }
}

TEST(LowLight, NoiseDependsOnSeedAndFrameAlone) {
  const cv::Mat image = test_color();
  const auto differ = [](const cv::Mat& a, const cv::Mat& b) { return cv::countNonZero(a != b); };
  const cv::Mat dark = LowLight(0.5, 1).apply(image, 7);
  EXPECT_EQ(dark.type(), CV_8UC1);
  EXPECT_EQ(differ(dark, LowLight(0.5, 1).apply(image, 7)), 0);
  EXPECT_GT(differ(dark, LowLight(0.5, 1).apply(image, 8)), 100);
  EXPECT_GT(differ(dark, LowLight(0.5, 2).apply(image, 7)), 100);
}

TEST(LowLight, RefusesGainsOutOfRange) {
  for (const double gain : {0.0, -1.0, 1.5, std::nan("")}) {
    EXPECT_THROW(LowLight{gain}, InputError) << gain;
  }
}

}  // namespace
}  // namespace dxslam
