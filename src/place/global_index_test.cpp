// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "place/global_index.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "core/error.h"
#include "core/random_unit.h"

namespace dxslam {
namespace {

float dot(const std::vector<float>& a, const std::vector<float>& b) {
  float sum = 0.0F;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

TEST(GlobalIndex, FindsWhatAPlainSearchFinds) {
  std::mt19937 random(3);
  GlobalIndex index;
  std::vector<std::vector<float>> stored;
  for (std::uint32_t id = 0; id < 200; ++id) {
    stored.push_back(random_unit(random, 37));  // no multiple of any register
    index.add(id, stored.back());
  }
  const std::vector<float> wanted = random_unit(random, 37);
  std::vector<std::pair<float, std::uint32_t>> expected;
  for (std::uint32_t id = 0; id < 200; ++id) expected.emplace_back(-dot(stored[id], wanted), id);
  std::sort(expected.begin(), expected.end());
  const std::vector<GlobalMatch> found = index.query(wanted, 10);
  ASSERT_EQ(found.size(), 10U);
  for (std::size_t i = 0; i < 10; ++i) {
    EXPECT_EQ(found[i].id, expected[i].second) << i;
    EXPECT_NEAR(found[i].similarity, -expected[i].first, 1e-5F) << i;
  }
}

TEST(GlobalIndex, ForgetsWhatIsRemovedAndKeepsTheRest) {
  std::mt19937 random(4);
  GlobalIndex index;
  std::vector<std::vector<float>> stored;
  for (std::uint32_t id = 0; id < 50; ++id) {
    stored.push_back(random_unit(random, 16));
    index.add(1000 + id, stored.back());
  }
  for (std::uint32_t id = 0; id < 50; id += 3) EXPECT_TRUE(index.remove(1000 + id));
  EXPECT_FALSE(index.remove(1000));
  EXPECT_FALSE(index.remove(7));
  EXPECT_EQ(index.size(), 33U);
  for (std::uint32_t id = 0; id < 50; ++id) {
    const std::vector<GlobalMatch> found = index.query(stored[id], 1);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found.front().id == 1000 + id, id % 3 != 0) << id;
    EXPECT_EQ(index.contains(1000 + id), id % 3 != 0) << id;
  }
}

TEST(GlobalIndex, ADescriptorAddedAgainReplacesTheOldOne) {
  GlobalIndex index;
  index.add(5, {1.0F, 0.0F});
  index.add(5, {0.0F, 1.0F});
  EXPECT_EQ(index.size(), 1U);
  EXPECT_NEAR(index.query({0.0F, 1.0F}, 1).front().similarity, 1.0F, 1e-6F);
}

TEST(GlobalIndex, EqualSimilaritiesComeByRisingId) {
  GlobalIndex index;
  for (const std::uint32_t id : {9U, 2U, 5U}) index.add(id, {0.6F, 0.8F});
  const std::vector<GlobalMatch> found = index.query({1.0F, 0.0F}, 3);
  ASSERT_EQ(found.size(), 3U);
  EXPECT_EQ(found[0].id, 2U);
  EXPECT_EQ(found[1].id, 5U);
  EXPECT_EQ(found[2].id, 9U);
}

TEST(GlobalIndex, LeavesOutWhatIsExcluded) {
  GlobalIndex index;
  for (const std::uint32_t id : {1U, 2U, 3U}) index.add(id, {0.6F, 0.8F});
  const auto found = index.query({1.0F, 0.0F}, 3, [](std::uint32_t id) { return id != 2; });
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found.front().id, 2U);
}

TEST(GlobalIndex, ComparesWithOneAsAmongAll) {
  std::mt19937 random(5);
  GlobalIndex index;
  for (std::uint32_t id = 0; id < 5; ++id) index.add(id, random_unit(random, 64));
  const std::vector<float> wanted = random_unit(random, 64);
  for (const GlobalMatch& match : index.query(wanted, 5)) {
    EXPECT_EQ(index.compare(match.id, wanted).similarity, match.similarity);
    EXPECT_NEAR(match.distance() * match.distance(), 2.0 - 2.0 * match.similarity, 1e-6);
  }
  EXPECT_THROW(index.compare(9, wanted), ContractError);
  EXPECT_THROW(index.compare(0, {1.0F}), ContractError);
}

TEST(GlobalIndex, IsAskedForMoreThanItHasOrWithNothing) {
  GlobalIndex index;
  EXPECT_TRUE(index.query({1.0F, 0.0F}, 5).empty());
  index.add(1, {1.0F, 0.0F});
  EXPECT_EQ(index.query({1.0F, 0.0F}, 5).size(), 1U);
  EXPECT_TRUE(index.query({}, 5).empty());
  EXPECT_TRUE(index.remove(1));
  EXPECT_TRUE(index.query({1.0F, 0.0F}, 5).empty());
}

TEST(GlobalIndex, RefusesOtherDimensions) {
  GlobalIndex index;
  EXPECT_THROW(index.add(1, {}), ContractError);
  index.add(1, {1.0F, 0.0F});
  EXPECT_THROW(index.add(2, {1.0F}), ContractError);
  EXPECT_THROW(index.query({1.0F, 0.0F, 0.0F}, 1), ContractError);
}

}  // namespace
}  // namespace dxslam
