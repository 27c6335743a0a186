// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "matching/descriptor_matching.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bitset>
#include <numeric>
#include <random>
#include <utility>

#include "core/error.h"
#include "core/random_unit.h"
#include "core/test_simd.h"
#include "matching/descriptor_distance.h"

namespace dxslam {
namespace {

cv::Mat random_unit_rows(int rows, int dim, unsigned seed) {
  std::mt19937 generator(seed);
  cv::Mat m(rows, dim, CV_32F);
  for (int i = 0; i < rows; ++i) {
    cv::Mat(random_unit(generator, static_cast<std::size_t>(dim))).reshape(1, 1).copyTo(m.row(i));
  }
  return m;
}

cv::Mat random_bytes(int rows, int bytes, unsigned seed) {
  std::mt19937 generator(seed);
  cv::Mat m(rows, bytes, CV_8U);
  for (int i = 0; i < rows; ++i) {
    for (int d = 0; d < bytes; ++d)
      m.at<std::uint8_t>(i, d) = static_cast<std::uint8_t>(generator());
  }
  return m;
}

float slow_similarity(const cv::Mat& a, int i, const cv::Mat& b, int j) {
  double sum = 0.0;
  for (int d = 0; d < a.cols; ++d) {
    if (a.depth() == CV_32F) {
      sum += static_cast<double>(a.at<float>(i, d)) * b.at<float>(j, d);
    } else {
      sum -= static_cast<double>(
          std::bitset<8>(static_cast<unsigned>(a.at<std::uint8_t>(i, d) ^ b.at<std::uint8_t>(j, d)))
              .count());
    }
  }
  return static_cast<float>(sum);
}

class Similarities : public testing::TestWithParam<std::tuple<int, int, int, bool>> {};

TEST_P(Similarities, EqualTheSlowReference) {
  const auto [rows_a, rows_b, dim, binary] = GetParam();
  const cv::Mat a = binary ? random_bytes(rows_a, dim, 1) : random_unit_rows(rows_a, dim, 1);
  const cv::Mat b = binary ? random_bytes(rows_b, dim, 2) : random_unit_rows(rows_b, dim, 2);
  std::vector<float> fast(static_cast<std::size_t>(rows_a * rows_b));
  for (const SimdLevel level : testing_support::simd_levels()) {
    set_simd_level(level);
    descriptor_similarities(a, b, fast.data());
    for (int i = 0; i < rows_a; ++i) {
      for (int j = 0; j < rows_b; ++j) {
        const float slow = slow_similarity(a, i, b, j);
        ASSERT_NEAR(fast[static_cast<std::size_t>(i * rows_b + j)], slow, 1e-5F) << i << " " << j;
        ASSERT_NEAR(descriptor_distance(a, i, b, j), distance_of_similarity(slow, binary), 1e-3F);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, Similarities,
                         testing::Values(std::tuple{1, 1, 64, false}, std::tuple{7, 17, 64, false},
                                         std::tuple{13, 33, 256, false},
                                         std::tuple{6, 16, 5, false}, std::tuple{1, 1, 32, true},
                                         std::tuple{9, 20, 32, true}, std::tuple{5, 4, 61, true}));

TEST(DescriptorSimilarities, RefuseRowsOfDifferentKinds) {
  std::vector<float> out(4);
  EXPECT_THROW(
      descriptor_similarities(random_unit_rows(2, 64, 1), random_unit_rows(2, 32, 1), out.data()),
      ContractError);
  EXPECT_THROW(
      descriptor_similarities(random_unit_rows(2, 32, 1), random_bytes(2, 32, 1), out.data()),
      ContractError);
}

std::vector<int> slow_nearest(const cv::Mat& a, int i, const cv::Mat& b) {
  std::vector<int> order(static_cast<std::size_t>(b.rows));
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int j, int k) {
    return slow_similarity(a, i, b, j) > slow_similarity(a, i, b, k);
  });
  return order;
}

class MutualMatches : public testing::TestWithParam<std::tuple<int, int, int, float>> {};

// Few bits have many equal distances, among them those of nearest and second nearest.
TEST_P(MutualMatches, EqualTheSlowReference) {
  const auto [rows_a, rows_b, bytes, ratio] = GetParam();
  const cv::Mat a = random_bytes(rows_a, bytes, 5);
  const cv::Mat b = random_bytes(rows_b, bytes, 6);
  std::vector<std::pair<int, int>> expected;
  for (int i = 0; i < rows_a; ++i) {
    const std::vector<int> order = slow_nearest(a, i, b);
    if (slow_nearest(b, order[0], a)[0] != i) continue;
    const float best = -slow_similarity(a, i, b, order[0]);
    if (rows_b > 1 && ratio < 1.0F && best >= ratio * -slow_similarity(a, i, b, order[1])) continue;
    expected.emplace_back(i, order[0]);
  }
  EXPECT_FALSE(expected.empty());
  for (const SimdLevel level : testing_support::simd_levels()) {
    set_simd_level(level);
    std::vector<std::pair<int, int>> found;
    for (const Match& m : match_mutual(a, b, 1000.0F, ratio)) found.emplace_back(m.a, m.b);
    EXPECT_EQ(found, expected);
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, MutualMatches,
                         testing::Values(std::tuple{1, 1, 2, 1.0F}, std::tuple{30, 15, 2, 1.0F},
                                         std::tuple{70, 16, 2, 0.9F}, std::tuple{25, 50, 1, 1.0F},
                                         std::tuple{90, 83, 3, 0.9F},
                                         std::tuple{100, 100, 4, 1.0F}));

TEST(MatchMutual, FindsAPermutation) {
  const cv::Mat a = random_unit_rows(50, 64, 3);
  cv::Mat b;
  for (int i = 49; i >= 0; --i) b.push_back(a.row(i));
  const std::vector<Match> matches = match_mutual(a, b, 0.5F, 0.9F);
  ASSERT_EQ(matches.size(), 50U);
  for (const Match& m : matches) EXPECT_EQ(m.a + m.b, 49);
}

TEST(MatchMutual, RatioTestDropsAmbiguousRowsAndDistanceFarOnes) {
  const cv::Mat a = random_unit_rows(2, 64, 4);
  cv::Mat b = a.row(0).clone();
  b.push_back(a.row(0));
  EXPECT_TRUE(match_mutual(a.row(0), b, 0.5F, 0.9F).empty());
  EXPECT_EQ(match_mutual(a.row(0), b, 0.5F, 1.0F).size(), 1U);
  EXPECT_TRUE(match_mutual(a.row(0), a.row(1), 0.5F, 1.0F).empty());
}

TEST(MatchMutual, NothingToMatchIsNoMatch) {
  EXPECT_TRUE(match_mutual(cv::Mat(), random_unit_rows(2, 64, 1), 2.0F, 1.0F).empty());
  EXPECT_TRUE(match_mutual(random_unit_rows(2, 64, 1), cv::Mat(), 2.0F, 1.0F).empty());
}

}  // namespace
}  // namespace dxslam
