// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/primitives/name_order.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace dxslam {
namespace {

std::vector<std::string> names(const std::vector<std::filesystem::path>& files) {
  std::vector<std::string> all;
  for (const auto& file : files) all.push_back(file.string());
  return all;
}

TEST(NameOrder, CountsNumbersByValue) {
  const std::vector<std::string> ordered = {"",
                                            "-1",
                                            "1",
                                            "2",
                                            "02a",
                                            "10",
                                            "a",
                                            "a1b2",
                                            "a1b10",
                                            "a01c",
                                            "a2",
                                            "frame1",
                                            "frame2",
                                            "frame9",
                                            "frame10",
                                            "frame010",
                                            "frame100000000000000000000",
                                            "frame100000000000000000001",
                                            "frames",
                                            "img1"};
  for (std::size_t i = 0; i < ordered.size(); ++i) {
    for (std::size_t j = 0; j < ordered.size(); ++j) {
      const bool equal_value = (ordered[i] == "frame10" && ordered[j] == "frame010") ||
                               (ordered[i] == "frame010" && ordered[j] == "frame10");
      if (equal_value) continue;
      EXPECT_EQ(natural_less(ordered[i], ordered[j]), i < j) << ordered[i] << " " << ordered[j];
    }
  }
  EXPECT_NE(natural_less("frame10", "frame010"), natural_less("frame010", "frame10"));
}

TEST(NameOrder, IsAnOrderOfAnyNames) {
  std::mt19937 random(3);
  const std::string letters = "a0129.-";
  std::vector<std::string> all(60);
  for (std::string& name : all) {
    for (unsigned k = random() % 5; k > 0; --k) name += letters[random() % letters.size()];
  }
  for (const auto& a : all) {
    for (const auto& b : all) {
      if (a != b) {
        EXPECT_NE(natural_less(a, b), natural_less(b, a)) << a << " " << b;
      }
      for (const auto& c : all) {
        if (natural_less(a, b) && natural_less(b, c)) {
          EXPECT_TRUE(natural_less(a, c));
        }
      }
    }
  }
}

TEST(NameOrder, TellsItsChoices) {
  std::vector<std::filesystem::path> files = {"d/frame10.jpg", "d/frame9.png", "d/frame1.jpg"};
  EXPECT_TRUE(sort_by_name(files).empty());
  EXPECT_THAT(names(files), testing::ElementsAre("d/frame1.jpg", "d/frame9.png", "d/frame10.jpg"));

  files = {"right1.png", "left2.png", "left1.png"};
  EXPECT_THAT(sort_by_name(files), testing::ElementsAre(testing::HasSubstr("'left#', 'right#'")));
  EXPECT_THAT(names(files), testing::ElementsAre("left1.png", "left2.png", "right1.png"));

  files = {"1305031102.2.png", "1305031102.1753.png"};
  EXPECT_EQ(sort_by_name(files).size(), 1U);
  EXPECT_THAT(names(files), testing::ElementsAre("1305031102.1753.png", "1305031102.2.png"));

  files = {"0.1.png", "0.066.png", "0.033.png"};
  EXPECT_THAT(sort_by_name(files), testing::ElementsAre(testing::HasSubstr("decimal numbers")));
  EXPECT_THAT(names(files), testing::ElementsAre("0.033.png", "0.066.png", "0.1.png"));

  files = {"1.10.png", "1.9.png"};
  EXPECT_THAT(sort_by_name(files), testing::ElementsAre(testing::HasSubstr("1.9 before 1.10")));
  EXPECT_THAT(names(files), testing::ElementsAre("1.9.png", "1.10.png"));

  files = {"1305031102.175304.png", "1305031102.211214.png"};
  EXPECT_TRUE(sort_by_name(files).empty());
}

}  // namespace
}  // namespace dxslam
