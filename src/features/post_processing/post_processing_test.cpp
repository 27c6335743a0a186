// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
//
// The quick post-processing against slow references written straight from the definitions.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>

#include "core/error.h"
#include "core/test_simd.h"
#include "features/post_processing/cell_scores.h"
#include "features/post_processing/dense_scores.h"
#include "features/post_processing/descriptor_detection.h"
#include "features/post_processing/descriptor_sampling.h"
#include "features/post_processing/keypoint_selection.h"
#include "features/post_processing/non_maximum_suppression.h"
#include "features/post_processing/subpixel.h"

namespace dxslam {
namespace {

using testing_support::simd_levels;
using Random = std::mt19937;

std::vector<float> random_values(Random& random, std::size_t count, float low, float high) {
  std::uniform_real_distribution<float> uniform(low, high);
  std::vector<float> values(count);
  for (float& v : values) v = uniform(random);
  return values;
}

double reference_log_probability(const TensorView& logits, int row, int column, int channel) {
  double peak = -1e30;
  for (int c = 0; c < logits.channels; ++c) {
    peak = std::max(peak, static_cast<double>(logits.value(c, row, column)));
  }
  double sum = 0.0;
  for (int c = 0; c < logits.channels; ++c) {
    sum += std::exp(logits.value(c, row, column) - peak);
  }
  return logits.value(channel, row, column) - peak - std::log(sum);
}

void expect_softmax(int cell, float low, float high, Random& random) {
  const int channels = cell * cell + 1;
  const int rows = 7;
  const int columns = 9;
  const auto values = random_values(
      random, static_cast<std::size_t>(rows) * columns * static_cast<std::size_t>(channels), low,
      high);
  const auto logits = TensorView::nhwc(values.data(), channels, rows, columns);
  const double resolution = 1e-7 * std::max(std::abs(low), std::abs(high));  // of the logits
  for (const SimdLevel level : simd_levels()) {
    set_simd_level(level);
    CellScores scores(cell);
    const TensorView map = scores.log_probabilities(logits);
    ASSERT_EQ(map.width, columns * cell);
    ASSERT_EQ(map.height, rows * cell);
    for (int y = 0; y < rows * cell; ++y) {
      for (int x = 0; x < columns * cell; ++x) {
        const double truth =
            reference_log_probability(logits, y / cell, x / cell, (y % cell) * cell + x % cell);
        EXPECT_NEAR(*map.at(y, x), truth, 5e-6 + 1e-6 * std::abs(truth) + resolution)
            << "cell " << cell << " at " << x << " " << y;
      }
    }
  }
}

TEST(CellScores, EqualASoftmaxOverEachCell) {
  Random random(1);
  for (const int cell : {8, 4, 5}) {
    expect_softmax(cell, -60.0F, 40.0F, random);
    expect_softmax(cell, -12.0F, 8.0F, random);
    expect_softmax(cell, -300.0F, 200.0F, random);   // beyond what exponentials hold
    expect_softmax(cell, -200.0F, -100.0F, random);  // below
  }
}

TEST(CellScores, StayFiniteForHugeLogits) {
  std::vector<float> values(65, -3e4F);
  values[20] = 3e4F;
  CellScores scores(8);
  const TensorView map = scores.log_probabilities(TensorView::nhwc(values.data(), 65, 1, 1));
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 8; ++x) {
      EXPECT_FLOAT_EQ(*map.at(y, x), x == 4 && y == 2 ? 0.0F : -6e4F);
    }
  }
}

TEST(CellScores, RefuseAMapOfAnotherLayout) {
  const std::vector<float> values(64 * 4, 0.0F);
  CellScores scores(8);
  EXPECT_THROW(scores.log_probabilities(TensorView::nhwc(values.data(), 64, 2, 2)), ContractError);
}

/// Dense iterated suppression, as the literature writes it: maxima by maximum filters over the
/// whole map. Ties are broken by `better` in place of equality of floats.
std::vector<Candidate> reference_suppression(const std::vector<Candidate>& candidates, int width,
                                             int height, int radius, int iterations) {
  std::vector<const Candidate*> map(static_cast<std::size_t>(width * height), nullptr);
  for (const Candidate& c : candidates) map[static_cast<std::size_t>(c.y * width + c.x)] = &c;
  const auto maxima_of = [&](const std::vector<const Candidate*>& scores) {
    std::vector<char> is_maximum(scores.size(), 0);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const Candidate* here = scores[static_cast<std::size_t>(y * width + x)];
        bool best = here != nullptr;
        for (int v = std::max(0, y - radius); v <= std::min(height - 1, y + radius); ++v) {
          for (int u = std::max(0, x - radius); u <= std::min(width - 1, x + radius); ++u) {
            const Candidate* other = scores[static_cast<std::size_t>(v * width + u)];
            if (best && other != nullptr && other != here) best = better(*here, *other);
          }
        }
        is_maximum[static_cast<std::size_t>(y * width + x)] = best ? 1 : 0;
      }
    }
    return is_maximum;
  };
  std::vector<char> kept = maxima_of(map);
  for (int pass = 0; pass < iterations; ++pass) {
    auto left = map;
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        for (int v = std::max(0, y - radius); v <= std::min(height - 1, y + radius); ++v) {
          for (int u = std::max(0, x - radius); u <= std::min(width - 1, x + radius); ++u) {
            if (kept[static_cast<std::size_t>(v * width + u)] != 0) {
              left[static_cast<std::size_t>(y * width + x)] = nullptr;
            }
          }
        }
      }
    }
    const auto more = maxima_of(left);
    for (std::size_t i = 0; i < kept.size(); ++i) kept[i] = kept[i] != 0 || more[i] != 0 ? 1 : 0;
  }
  std::vector<Candidate> result;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    if (kept[i] != 0) result.push_back(*map[i]);
  }
  return result;
}

std::vector<std::pair<int, int>> sorted_pixels(const std::vector<Candidate>& candidates) {
  std::vector<std::pair<int, int>> pixels;
  for (const Candidate& c : candidates) pixels.emplace_back(c.y, c.x);
  std::sort(pixels.begin(), pixels.end());
  return pixels;
}

std::vector<Candidate> random_candidates(Random& random, int width, int height, double density,
                                         int distinct_scores) {
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::vector<Candidate> candidates;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      if (uniform(random) > density) continue;
      const double score = std::floor(uniform(random) * distinct_scores) / distinct_scores;
      candidates.push_back({x, y, static_cast<float>(score) - 0.7F});
    }
  }
  return candidates;
}

TEST(NonMaximumSuppression, EqualsTheDenseFormForRandomMaps) {
  Random random(3);
  NonMaximumSuppression suppression;
  for (int round = 0; round < 60; ++round) {
    const int width = 20 + static_cast<int>(random() % 40);
    const int height = 20 + static_cast<int>(random() % 30);
    const int radius = static_cast<int>(random() % 6);
    const int iterations = static_cast<int>(random() % 4);
    // Few distinct scores make many ties.
    auto candidates = random_candidates(random, width, height, round % 2 == 0 ? 0.2 : 1.0,
                                        round % 3 == 0 ? 4 : 1 << 20);
    const auto expected = reference_suppression(candidates, width, height, radius, iterations);
    suppression.run(width, height, radius, iterations, candidates);
    EXPECT_EQ(sorted_pixels(candidates), sorted_pixels(expected))
        << width << "x" << height << " radius " << radius << " iterations " << iterations;
  }
}

TEST(NonMaximumSuppression, WithManyPassesLeavesNoTwoNearAndNothingToAdd) {
  Random random(4);
  NonMaximumSuppression suppression;
  const auto all = random_candidates(random, 64, 48, 0.5, 1 << 20);
  auto kept = all;
  constexpr int kRadius = 3;
  suppression.run(64, 48, kRadius, 64, kept);
  const auto near = [](const Candidate& a, const Candidate& b) {
    return std::max(std::abs(a.x - b.x), std::abs(a.y - b.y)) <= kRadius;
  };
  for (std::size_t i = 0; i < kept.size(); ++i) {
    for (std::size_t j = i + 1; j < kept.size(); ++j) EXPECT_FALSE(near(kept[i], kept[j]));
  }
  for (const Candidate& c : all) {
    EXPECT_TRUE(std::any_of(kept.begin(), kept.end(), [&](const Candidate& k) {
      return near(c, k) && (k.score >= c.score);
    }));
  }
}

TEST(NonMaximumSuppression, LeavesItsMapCleanForTheNextImage) {
  NonMaximumSuppression suppression;
  std::vector<Candidate> first{{10, 10, 5.0F}, {30, 20, 4.0F}};
  suppression.run(64, 48, 4, 2, first);
  std::vector<Candidate> second{{11, 11, 1.0F}};
  suppression.run(64, 48, 4, 2, second);
  EXPECT_EQ(second.size(), 1U);
}

TEST(KeypointSelection, WithoutSpreadTakesTheBestInOrder) {
  Random random(5);
  auto candidates = random_candidates(random, 100, 80, 0.3, 50);
  auto expected = candidates;
  std::sort(expected.begin(), expected.end(), better);
  expected.resize(123);
  std::shuffle(candidates.begin(), candidates.end(), random);
  select_keypoints(100, 80, 123, 0.0, 20, candidates);
  ASSERT_EQ(candidates.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(candidates[i].x, expected[i].x);
    EXPECT_EQ(candidates[i].y, expected[i].y);
  }
}

TEST(KeypointSelection, GivesEachCellItsQuotaFirst) {
  // One corner holds all the high scores; every cell has three low ones.
  std::vector<Candidate> candidates;
  for (int i = 0; i < 400; ++i)
    candidates.push_back({i % 20, i / 20, 10.0F + static_cast<float>(i)});
  for (int cell = 0; cell < 16; ++cell) {
    for (int k = 0; k < 3; ++k) {
      candidates.push_back({(cell % 4) * 20 + 5 + k, (cell / 4) * 20 + 5, static_cast<float>(k)});
    }
  }
  const auto per_cell = [](const std::vector<Candidate>& chosen) {
    std::vector<int> counts(16, 0);
    for (const Candidate& c : chosen) ++counts[static_cast<std::size_t>((c.y / 20) * 4 + c.x / 20)];
    return counts;
  };
  auto spread = candidates;
  select_keypoints(80, 80, 64, 0.5, 20, spread);  // 2 a cell, then 32 by score
  EXPECT_EQ(spread.size(), 64U);
  const auto counts = per_cell(spread);
  EXPECT_EQ(counts[0], 34);
  for (std::size_t i = 1; i < 16; ++i) EXPECT_EQ(counts[i], 2);
  auto plain = candidates;
  select_keypoints(80, 80, 64, 0.0, 20, plain);
  EXPECT_EQ(per_cell(plain)[0], 64);
}

TEST(KeypointSelection, DoesNotDependOnTheOrderOfTheInput) {
  Random random(6);
  const auto candidates = random_candidates(random, 120, 90, 0.4, 8);  // many ties
  std::vector<std::pair<int, int>> first;
  for (int round = 0; round < 5; ++round) {
    auto shuffled = candidates;
    std::shuffle(shuffled.begin(), shuffled.end(), random);
    select_keypoints(120, 90, 200, 0.6, 30, shuffled);
    std::vector<std::pair<int, int>> pixels;
    for (const Candidate& c : shuffled) pixels.emplace_back(c.y, c.x);
    if (round == 0) first = pixels;
    EXPECT_EQ(pixels, first);
  }
}

TEST(KeypointSelection, KeepsAllWhereThereAreFew) {
  std::vector<Candidate> candidates{{1, 1, 0.1F}, {2, 2, 0.9F}};
  select_keypoints(64, 64, 10, 1.0, 16, candidates);
  ASSERT_EQ(candidates.size(), 2U);
  EXPECT_FLOAT_EQ(candidates[0].score, 0.9F);
}

/// Bilinear interpolation in double, straight from the definition.
std::vector<double> reference_sample(const TensorView& map, const SamplingGrid& grid, double x,
                                     double y) {
  const auto place = [&](double p, int cells) {
    const double q = grid.align_corners ? p * (cells - 1) / (cells * grid.stride - 1.0)
                                        : (p + 0.5) / grid.stride - 0.5;
    return std::min(std::max(q, 0.0), cells - 1.0);
  };
  const double u = place(x, map.width);
  const double v = place(y, map.height);
  std::vector<double> out(static_cast<std::size_t>(map.channels), 0.0);
  double norm = 0.0;
  for (int c = 0; c < map.channels; ++c) {
    double value = 0.0;
    for (int j = 0; j < map.height; ++j) {
      for (int i = 0; i < map.width; ++i) {
        const double weight =
            std::max(0.0, 1.0 - std::abs(u - i)) * std::max(0.0, 1.0 - std::abs(v - j));
        value += weight * map.value(c, j, i);
      }
    }
    out[static_cast<std::size_t>(c)] = value;
    norm += value * value;
  }
  for (double& value : out) value /= std::sqrt(norm);
  return out;
}

TEST(DescriptorSampling, EqualsBilinearInterpolationInBothConventionsAndLayouts) {
  Random random(7);
  std::uniform_real_distribution<float> uniform(0.0F, 1.0F);
  for (const int channels : {64, 256, 37, 3}) {
    const int height = 6;
    const int width = 8;
    const auto values =
        random_values(random, static_cast<std::size_t>(height * width * channels), -1.0F, 1.0F);
    for (const bool side_by_side : {true, false}) {
      const auto map = side_by_side ? TensorView::nhwc(values.data(), channels, height, width)
                                    : TensorView::nchw(values.data(), channels, height, width);
      for (const bool align_corners : {false, true}) {
        const SamplingGrid grid{8, align_corners};
        std::vector<cv::Point2f> positions{{0.0F, 0.0F}, {63.0F, 47.0F}, {3.5F, 3.5F}};
        for (int i = 0; i < 20; ++i) {
          positions.emplace_back(uniform(random) * 63.0F, uniform(random) * 47.0F);
        }
        for (const SimdLevel level : simd_levels()) {
          set_simd_level(level);
          const cv::Mat sampled = sample_descriptors(map, grid, positions);
          for (std::size_t i = 0; i < positions.size(); ++i) {
            const auto expected = reference_sample(map, grid, positions[i].x, positions[i].y);
            for (int c = 0; c < channels; ++c) {
              EXPECT_NEAR(sampled.at<float>(static_cast<int>(i), c),
                          expected[static_cast<std::size_t>(c)], 5e-6);
            }
          }
        }
      }
    }
  }
}

TEST(DescriptorSampling, LeavesAZeroVectorZero) {
  const std::vector<float> values(16 * 4, 0.0F);
  const cv::Mat sampled =
      sample_descriptors(TensorView::nhwc(values.data(), 16, 2, 2), {8, false}, {{4.0F, 4.0F}});
  EXPECT_EQ(cv::countNonZero(sampled), 0);
}

TEST(DenseScores, MaximaEqualSuppressionOfAllCandidates) {
  Random random(8);
  const int width = 50;
  const int height = 40;
  for (const float steps : {20.0F, 1e6F}) {  // with ties and without
    auto values = random_values(random, static_cast<std::size_t>(width * height), 0.0F, 1.0F);
    for (float& v : values) v = std::round(v * steps) / steps;
    const auto map = TensorView::nchw(values.data(), 1, height, width);
    const PixelArea area{1, 3, 45, 39};
    for (const int radius : {1, 2, 3, 4, 8}) {
      NonMaximumSuppression suppression;
      std::vector<Candidate> all;
      find_candidates(map, 0.3F, all);
      suppression.run(width, height, radius, 0, all);
      all.erase(std::remove_if(all.begin(), all.end(),
                               [&](const Candidate& c) { return !area.contains(c.x, c.y); }),
                all.end());
      for (const SimdLevel level : simd_levels()) {
        set_simd_level(level);
        std::vector<Candidate> maxima;
        find_maxima(map, 0.3F, area, radius, maxima);
        EXPECT_EQ(sorted_pixels(all), sorted_pixels(maxima)) << "radius " << radius;
      }
    }
  }
}

TEST(DenseScores, FindsExactlyThePixelsAboveTheThreshold) {
  Random random(9);
  const auto values = random_values(random, 33 * 21, -5.0F, 5.0F);
  const auto map = TensorView::nchw(values.data(), 1, 21, 33);
  std::vector<Candidate> found;
  find_candidates(map, 1.25F, found);
  std::size_t expected = 0;
  for (const float v : values) expected += v > 1.25F ? 1U : 0U;
  EXPECT_EQ(found.size(), expected);
  for (const Candidate& c : found) EXPECT_FLOAT_EQ(c.score, map.value(0, c.y, c.x));
}

TEST(DenseScores, RefusesAnAreaOnTheRim) {
  const std::vector<float> values(100, 0.0F);
  const auto map = TensorView::nchw(values.data(), 1, 10, 10);
  std::vector<Candidate> found;
  EXPECT_THROW(find_maxima(map, 0.0F, {0, 1, 9, 9}, 1, found), ContractError);
  EXPECT_THROW(find_maxima(map, 0.0F, {1, 1, 9, 10}, 1, found), ContractError);
}

TEST(Subpixel, FindsTheTopOfAGaussianExactly) {
  const double true_x = 10.3;
  const double true_y = 6.8;
  const auto log_score = [&](int x, int y) {
    return static_cast<float>(-0.5 * ((x - true_x) * (x - true_x) + (y - true_y) * (y - true_y)));
  };
  const cv::Point2f offset = peak_offset(log_score, 10, 7);
  EXPECT_NEAR(offset.x, 0.3, 1e-5);
  EXPECT_NEAR(offset.y, -0.2, 1e-5);
}

TEST(Subpixel, StaysWithinHalfAPixelAndIgnoresFlatGround) {
  EXPECT_FLOAT_EQ(parabola_offset(1.0F, 1.0F, 1.0F), 0.0F);
  EXPECT_FLOAT_EQ(parabola_offset(0.0F, 1.0F, 2.0F), 0.0F);  // no top
  EXPECT_FLOAT_EQ(parabola_offset(0.0F, 1.0F, 1.9F), 0.5F);
}

TEST(DescriptorDetection, FindsAPeakOfItsStrongestChannelAndNoEdge) {
  constexpr int kChannels = 4;
  constexpr int kSide = 12;
  std::vector<float> values(kChannels * kSide * kSide, 0.1F);
  const auto at = [&](int c, int y, int x) -> float& {
    return values[static_cast<std::size_t>((c * kSide + y) * kSide + x)];
  };
  at(2, 4, 5) = 3.0F;                                                            // a peak
  for (int x = 0; x < kSide; ++x) at(1, 9, x) = 2.0F + (x == 7 ? 0.05F : 0.0F);  // a ridge
  std::vector<Candidate> found;
  find_descriptor_maxima(TensorView::nchw(values.data(), kChannels, kSide, kSide), 8, 0.15, found);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].x, 44);
  EXPECT_EQ(found[0].y, 36);
  const double expected = 1.0 / (1.0 + 8.0 * std::exp(0.1 - 3.0));
  EXPECT_NEAR(found[0].score, expected, 1e-5);
}

}  // namespace
}  // namespace dxslam
