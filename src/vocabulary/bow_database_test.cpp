// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "vocabulary/bow_database.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>

#include "core/error.h"

namespace dxslam {
namespace {

BowVector random_vector(std::mt19937& random, WordId words = 300, int entries = 20) {
  std::uniform_int_distribution<WordId> word(0, words - 1);
  std::uniform_real_distribution<float> weight(0.1F, 2.0F);
  std::vector<std::pair<WordId, float>> list;
  for (int i = 0; i < entries; ++i) list.emplace_back(word(random), weight(random));
  return make_bow_vector(list);
}

// All images compared one by one.
std::vector<BowMatch> search_all(const std::map<std::uint32_t, BowVector>& images,
                                 const BowVector& query, std::size_t k,
                                 const std::function<bool(std::uint32_t)>& excluded = {}) {
  std::vector<BowMatch> matches;
  for (const auto& [id, vector] : images) {
    const double score = bow_score(query, vector);
    if (score > 0.0 && !(excluded && excluded(id))) matches.push_back({id, score});
  }
  std::stable_sort(matches.begin(), matches.end(),
                   [](const BowMatch& a, const BowMatch& b) { return a.score > b.score; });
  if (matches.size() > k) matches.resize(k);
  return matches;
}

void expect_equal(const std::vector<BowMatch>& found, const std::vector<BowMatch>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found[i].id, expected[i].id) << "place " << i;
    EXPECT_EQ(found[i].score, expected[i].score) << "place " << i;  // to the bit
  }
}

struct Collection {
  explicit Collection(std::uint32_t count) {
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint32_t id = (i * 7919U) % 100003U;  // not in order
      images[id] = random_vector(random);
      database.add(id, images[id]);
    }
  }
  std::mt19937 random{5};
  std::map<std::uint32_t, BowVector> images;
  BowDatabase database;
};

TEST(BowDatabase, FindsWhatASearchThroughAllFinds) {
  Collection c(400);
  for (int i = 0; i < 20; ++i) {
    const BowVector query = random_vector(c.random);
    for (const std::size_t k : {1U, 10U, 1000U}) {
      expect_equal(c.database.query(query, k), search_all(c.images, query, k));
    }
  }
}

TEST(BowDatabase, LeavesOutExcludedImages) {
  Collection c(400);
  const auto even = [](std::uint32_t id) { return id % 2 == 0; };
  const BowVector query = random_vector(c.random);
  expect_equal(c.database.query(query, 15, even), search_all(c.images, query, 15, even));
  EXPECT_TRUE(c.database.query(query, 15, [](std::uint32_t) { return true; }).empty());
}

TEST(BowDatabase, RanksEqualScoresById) {
  std::mt19937 random(1);
  const BowVector vector = random_vector(random);
  BowDatabase database;
  for (const std::uint32_t id : {9U, 3U, 12U, 6U}) database.add(id, vector);
  std::vector<std::uint32_t> ids;
  for (const BowMatch& match : database.query(vector, 3)) ids.push_back(match.id);
  EXPECT_THAT(ids, testing::ElementsAre(3U, 6U, 9U));
}

TEST(BowDatabase, ForgetsRemovedImagesAndTakesThemAgain) {
  Collection c(3000);
  std::vector<std::uint32_t> ids;
  for (const auto& entry : c.images) ids.push_back(entry.first);
  for (std::size_t i = 0; i < ids.size(); ++i) {
    if (i % 3 == 0) continue;  // two thirds go: the database is compacted on the way
    c.database.remove(ids[i]);
    c.images.erase(ids[i]);
  }
  c.database.remove(4000000000U);  // never was there
  EXPECT_EQ(c.database.size(), c.images.size());
  EXPECT_FALSE(c.database.contains(ids[1]));
  const BowVector query = random_vector(c.random);
  expect_equal(c.database.query(query, 25), search_all(c.images, query, 25));
  c.images[ids[1]] = query;
  c.database.add(ids[1], query);
  expect_equal(c.database.query(query, 25), search_all(c.images, query, 25));
}

TEST(BowDatabase, RefusesAnIdTwice) {
  BowDatabase database;
  database.add(4, BowVector());
  EXPECT_THROW(database.add(4, BowVector()), ContractError);
  EXPECT_EQ(database.size(), 1U);
}

TEST(BowDatabase, HasNoAnswerForNothing) {
  Collection c(10);
  EXPECT_TRUE(c.database.query(BowVector(), 5).empty());
  EXPECT_TRUE(c.database.query(random_vector(c.random), 0).empty());
  // Words that no image has are beyond the end of the index.
  EXPECT_TRUE(c.database.query(make_bow_vector({{1000000, 1.0F}}), 5).empty());
  c.database.clear();
  EXPECT_EQ(c.database.size(), 0U);
  EXPECT_TRUE(c.database.query(random_vector(c.random), 5).empty());
}

}  // namespace
}  // namespace dxslam
