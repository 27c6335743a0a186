// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "vocabulary/bow_vector.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace dxslam {
namespace {

using testing::ElementsAre;
using testing::Pair;

constexpr WordId kWords = 60;

BowVector random_vector(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<WordId> word(0, kWords - 1);
  std::uniform_real_distribution<float> weight(0.01F, 3.0F);
  std::vector<std::pair<WordId, float>> entries;
  for (int i = 0; i < 30; ++i) entries.emplace_back(word(random), weight(random));
  return make_bow_vector(entries);
}

// The formula of the paper, word for word over all N words.
double score_of_paper(const BowVector& a, const BowVector& b) {
  std::vector<double> v1(kWords, 0.0);
  std::vector<double> v2(kWords, 0.0);
  for (const auto& [word, value] : a.words) v1[word] = value;
  for (const auto& [word, value] : b.words) v2[word] = value;
  double sum = 0.0;
  for (WordId i = 0; i < kWords; ++i) {
    sum += std::abs(v1[i]) + std::abs(v2[i]) - std::abs(v1[i] - v2[i]);
  }
  return sum;
}

TEST(BowVector, SumsEntriesOfOneWordSortsAndScalesToOne) {
  const BowVector vector = make_bow_vector({{7, 1.0F}, {2, 0.5F}, {7, 2.0F}, {4, 0.5F}});
  EXPECT_THAT(vector.words, ElementsAre(Pair(2U, 0.125F), Pair(4U, 0.125F), Pair(7U, 0.75F)));
}

TEST(BowVector, DropsWordsWithoutWeight) {
  EXPECT_THAT(make_bow_vector({{3, 0.0F}, {5, 2.0F}}).words, ElementsAre(Pair(5U, 1.0F)));
  EXPECT_TRUE(make_bow_vector({{3, 0.0F}}).empty());
  EXPECT_TRUE(make_bow_vector({}).empty());
}

TEST(BowScore, IsThatOfThePaper) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    const BowVector a = random_vector(2 * seed);
    const BowVector b = random_vector(2 * seed + 1);
    EXPECT_NEAR(bow_score(a, b), score_of_paper(a, b), 1e-12);
    EXPECT_EQ(bow_score(a, b), bow_score(b, a));
  }
}

TEST(BowScore, GoesFromZeroForNothingSharedToTwoForEquals) {
  const BowVector a = make_bow_vector({{1, 1.0F}, {3, 2.0F}});
  const BowVector b = make_bow_vector({{2, 1.0F}, {4, 2.0F}});
  EXPECT_EQ(bow_score(a, b), 0.0);
  EXPECT_EQ(bow_score(a, BowVector()), 0.0);
  EXPECT_NEAR(bow_score(a, a), 2.0, 1e-6);
}

}  // namespace
}  // namespace dxslam
