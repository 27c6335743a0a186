// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "matching/guided_matching.h"

#include <gtest/gtest.h>

#include <random>

namespace dxslam {
namespace {

Frame frame_of(const std::vector<Eigen::Vector2f>& pixels, const cv::Mat& descriptors) {
  Frame frame;
  frame.pixels = pixels;
  frame.depths.assign(pixels.size(), 2.0F);
  frame.scores.assign(pixels.size(), 1.0F);
  frame.sigmas.assign(pixels.size(), 1.0F);
  frame.descriptors = descriptors;
  return frame;
}

const cv::Mat kAxes = cv::Mat::eye(4, 4, CV_32F);
const GuidedMatchingOptions kOptions{0.9F, 0.9F, 0.15F};

TEST(KeypointGrid, FindsWhatASlowSearchFinds) {
  std::mt19937 generator(5);
  std::uniform_real_distribution<float> uniform(-20.0F, 300.0F);
  std::vector<Eigen::Vector2f> pixels;
  for (int i = 0; i < 400; ++i) pixels.emplace_back(uniform(generator), uniform(generator));
  const KeypointGrid grid(pixels);
  for (int trial = 0; trial < 100; ++trial) {
    const Eigen::Vector2f center(uniform(generator), uniform(generator));
    const float radius = 5.0F + static_cast<float>(trial);
    std::vector<char> found(pixels.size(), 0);
    grid.for_each_within(center, radius, [&](int k) { ++found[static_cast<std::size_t>(k)]; });
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      ASSERT_EQ(found[i], (pixels[i] - center).squaredNorm() <= radius * radius ? 1 : 0);
    }
  }
}

TEST(KeypointGrid, AnEmptyOneFindsNothing) {
  const std::vector<Eigen::Vector2f> none;
  const KeypointGrid grid(none);
  grid.for_each_within({1.0F, 1.0F}, 100.0F, [](int) { FAIL(); });
}

// As of a map that somebody has tampered with, or a lens that could not be undistorted.
TEST(KeypointGrid, NeverFindsAPixelThatIsNotFinite) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  const std::vector<Eigen::Vector2f> pixels = {
      {nan, 5.0F}, {5.0F, 5.0F}, {5.0F, -infinity}, {1e30F, -1e30F}, {nan, nan}};
  const KeypointGrid grid(pixels);
  std::vector<int> found;
  grid.for_each_within({6.0F, 6.0F}, 10.0F, [&](int k) { found.push_back(k); });
  EXPECT_EQ(found, std::vector<int>{1});
  for (const Eigen::Vector2f& center : {pixels[0], pixels[2], pixels[4]}) {
    grid.for_each_within(center, 100.0F, [](int) { FAIL(); });
  }
}

TEST(MatchGuided, TakesTheNearestDescriptorWithinTheRadius) {
  const Frame frame = frame_of({{10, 10}, {12, 10}, {100, 100}}, kAxes.rowRange(0, 3));
  const KeypointGrid grid(frame.pixels);
  const std::vector<PixelPrediction> predictions = {{1, {11, 10}, 5.0F, 2.0F},
                                                    {2, {11, 10}, 5.0F, 2.0F}};
  const std::vector<Match> matches = match_guided(predictions, kAxes, frame, grid, {}, kOptions);
  ASSERT_EQ(matches.size(), 1U);
  EXPECT_EQ(matches[0].a, 0);
  EXPECT_EQ(matches[0].b, 1);
}

TEST(MatchGuided, AKeypointGoesToTheNearestOfTwoPredictions) {
  cv::Mat points = kAxes.row(0).clone();
  cv::Mat similar = 0.9F * kAxes.row(0) + 0.43589F * kAxes.row(1);
  points.push_back(similar);
  const Frame frame = frame_of({{10, 10}}, kAxes.row(0));
  const KeypointGrid grid(frame.pixels);
  const std::vector<PixelPrediction> predictions = {{1, {10, 10}, 5.0F, 0.0F},
                                                    {0, {10, 10}, 5.0F, 0.0F}};
  const std::vector<Match> matches = match_guided(predictions, points, frame, grid, {}, kOptions);
  ASSERT_EQ(matches.size(), 1U);
  EXPECT_EQ(matches[0].a, 1);
}

TEST(MatchGuided, PassesOverBlockedKeypointsAndOtherDepths) {
  const Frame frame = frame_of({{10, 10}}, kAxes.row(0));
  const KeypointGrid grid(frame.pixels);
  EXPECT_EQ(match_guided({{0, {10, 10}, 5.0F, 2.1F}}, kAxes, frame, grid, {}, kOptions).size(), 1U);
  EXPECT_TRUE(match_guided({{0, {10, 10}, 5.0F, 2.1F}}, kAxes, frame, grid, {1}, kOptions).empty());
  EXPECT_TRUE(match_guided({{0, {10, 10}, 5.0F, 3.0F}}, kAxes, frame, grid, {}, kOptions).empty());
  EXPECT_EQ(match_guided({{0, {10, 10}, 5.0F, 0.0F}}, kAxes, frame, grid, {}, kOptions).size(), 1U);
}

}  // namespace
}  // namespace dxslam
