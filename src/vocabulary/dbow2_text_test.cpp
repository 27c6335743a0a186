// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "vocabulary/dbow2_text.h"

#include <gtest/gtest.h>

#include <random>

#include "io/primitives/test_folder.h"
#include "vocabulary/test_vocabularies.h"
#include "vocabulary/vocabulary.h"

namespace dxslam {
namespace {

// k = 2, L = 2; nodes 1 (inner), 2 (word 0), 3 and 4 below node 1 (words 1 and 2).
constexpr const char* kSmall =
    "2 2 0 0\n"
    "0 0 255 255 0\n"
    "0 1 0 0 1.5\n"
    "1 1 255 240 2.5\n"
    "1 1 15 255 3.5\n";

cv::Mat byte_row(int a, int b) { return (cv::Mat_<std::uint8_t>(1, 2) << a, b); }

TEST(Dbow2Text, GivesWordsTheNumbersOfTheirLines) {
  const TestFolder folder;
  const Vocabulary vocabulary = Vocabulary::load(folder.write("v.txt", std::string(kSmall)));
  EXPECT_TRUE(vocabulary.binary());
  EXPECT_EQ(vocabulary.dimension(), 2);
  EXPECT_EQ(vocabulary.word_count(), 3U);
  EXPECT_EQ(vocabulary.words(byte_row(0, 1)).at(0), 0U);
  EXPECT_EQ(vocabulary.words(byte_row(255, 240)).at(0), 1U);
  EXPECT_EQ(vocabulary.words(byte_row(15, 255)).at(0), 2U);
  EXPECT_EQ(vocabulary.info().min_weight, 1.5F);
  EXPECT_EQ(vocabulary.info().max_weight, 3.5F);
}

TEST(Dbow2Text, TakesCarriageReturnsAndBlankLinesAtTheEnd) {
  std::string text = kSmall;
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2) {
    text.replace(at, 1, "\r\n");
  }
  EXPECT_EQ(parse_dbow2_text(text + "\r\n\n  \n", "v").nodes.size(), 5U);
}

TEST(Dbow2Text, SkipsAByteOrderMark) {
  EXPECT_EQ(parse_dbow2_text(std::string("\xEF\xBB\xBF") + kSmall, "v").nodes.size(), 5U);
}

TEST(Dbow2Text, ComesBackWithTheSameWords) {
  for (const bool binary : {false, true}) {
    const TestFolder folder;
    const Vocabulary vocabulary =
        Vocabulary::from_tree(test_tree(random_descriptors(binary, 300, 32, 1)));
    const Vocabulary back =
        Vocabulary::load(folder.write("v.txt", format_dbow2_text(vocabulary.tree())));
    EXPECT_EQ(back.binary(), binary);
    const cv::Mat queries = random_descriptors(binary, 200, 32, 2);
    EXPECT_EQ(back.words(queries), vocabulary.words(queries));
    EXPECT_EQ(back.transform(queries).words, vocabulary.transform(queries).words);
  }
}

TEST(Dbow2Text, KeepsWordIdsThatDoNotRiseWithTheNodes) {
  // As kSmall, but the inner node comes last: packed level by level its words come last as well,
  // though they have the ids 0 and 1.
  const std::string text = "2 2 0 0\n0 0 255 255 0\n1 1 255 240 2.5\n1 1 15 255 3.5\n0 1 0 0 1.5\n";
  const Vocabulary vocabulary = Vocabulary::from_tree(parse_dbow2_text(text, "v"));
  const VocabularyTree back = parse_dbow2_text(format_dbow2_text(vocabulary.tree()), "again");
  EXPECT_EQ(Vocabulary::from_tree(back).words(byte_row(0, 0)).at(0), 2U);
}

TEST(Dbow2Text, TellsFloatsWithoutFractionsFromBytes) {
  VocabularyTree tree = test_tree(random_descriptors(false, 2, 4, 3));
  tree.descriptors.setTo(0.0F);
  tree.descriptors.at<float>(1, 2) = 1.0F;
  tree.descriptors.at<float>(2, 3) = 1.0F;
  EXPECT_EQ(parse_dbow2_text(format_dbow2_text(tree), "v").descriptors.depth(), CV_32F);
}

struct Mistake {
  const char* text;
  const char* says;
};

TEST(Dbow2Text, RefusesMistakesNamingTheLine) {
  const std::vector<Mistake> mistakes = {
      {"", "is empty"},
      {"%YAML:1.0\n", "v:1: begins with '%YAML:1.0"},
      {"2 2 0\n", "v:1: weighting is ''"},
      {"2 2 6 0\n", "v:1: scoring is '6'"},
      {"2 2 0 0\n", "node 0 is no leaf but has no children"},
      {"2 2 0 0\n0 1\n", "v:2: has 2 fields"},
      {"2 2 0 0\n0 1 5 1.0\n1 1 5 1.0\n", "v:3: has parent 1, which is a leaf"},
      {"2 2 0 0\n0 1 5 1.0\n2 1 5 1.0\n", "v:3: parent is '2'"},
      {"2 2 0 0\n0 1 5 1.0\n-1 1 5 1.0\n", "v:3: parent is '-1'"},
      {"2 2 0 0\n0 2 5 1.0\n", "v:2: leaf flag is '2'"},
      {"2 2 0 0\n0 1 5 1.0\n0 1 256 1.0\n", "v:3: descriptor is '256'"},
      {"2 2 0 0\n0 1 5 1.0\n0 1 5 nan\n", "v:3: weight is 'nan'"},
      {"2 2 0 0\n0 1 5 1.0\n0 1 5 -1\n", "v:3: weight is '-1'"},
      {"2 2 0 0\n0 1 5 1.0\n0 1 5 6 1.0\n", "v:3: has more fields"},
      {"2 2 0 0\n0 1 5 1.0\n0 1 5\n", "v:3: weight is ''"},
      {"2 2 0 0\n0 1 5 1\n0 1 6 1\n0 1 7 1\n", "v:4: is one child of node 0 more than the 2"},
      {"2 2 0 0\n0 1 5 1\n0 0 6 0\n", "node 2 is no leaf but has no children"},
  };
  for (const Mistake& mistake : mistakes) {
    expect_input_error([&] { parse_dbow2_text(mistake.text, "v"); }, {mistake.says});
  }
}

TEST(Dbow2Text, SurvivesRandomDamage) {
  std::mt19937 random(23);
  const std::string good = format_dbow2_text(test_tree(random_descriptors(true, 20, 4, 4)));
  for (int round = 0; round < 3000; ++round) {
    std::string text = good;
    for (int n = 0; n < 3; ++n) text[random() % text.size()] = "0123 .-\nex"[random() % 10];
    try {
      Vocabulary::from_tree(parse_dbow2_text(text, "fuzz"));
    } catch (const InputError&) {
    }
  }
}

}  // namespace
}  // namespace dxslam
