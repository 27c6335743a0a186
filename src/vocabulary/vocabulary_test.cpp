// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "vocabulary/vocabulary.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <map>

#include "core/error.h"
#include "core/test_simd.h"
#include "vocabulary/test_vocabularies.h"

namespace dxslam {
namespace {

double distance(const cv::Mat& a, int i, const cv::Mat& b, int j) {
  double sum = 0.0;
  for (int d = 0; d < a.cols; ++d) {
    if (a.depth() == CV_8U) {
      sum +=
          std::popcount(static_cast<unsigned>(a.at<std::uint8_t>(i, d) ^ b.at<std::uint8_t>(j, d)));
    } else {
      const double difference = double{a.at<float>(i, d)} - b.at<float>(j, d);
      sum += difference * difference;
    }
  }
  return sum;
}

// Descends in plain scalar arithmetic, over the nodes of the tree. Where two children are as near
// as rounding, `words` holds what each leads to.
void descend(const VocabularyTree& tree, std::size_t node, const cv::Mat& query, int row,
             std::vector<WordId>& words) {
  if (tree.is_word(node)) {
    words.push_back(tree.nodes[node].word);
    return;
  }
  double least = 1e30;
  for (const std::uint32_t child : tree.nodes[node].children) {
    least = std::min(least, distance(query, row, tree.descriptors, static_cast<int>(child)));
  }
  for (const std::uint32_t child : tree.nodes[node].children) {
    const double d = distance(query, row, tree.descriptors, static_cast<int>(child));
    const bool binary = query.depth() == CV_8U;
    if (d > least + (binary ? 0.0 : 1e-6)) continue;
    descend(tree, child, query, row, words);
    if (binary) return;  // whole numbers: the first of equals
  }
}

struct Kind {
  bool binary;
  int dimension;
};

class QuantisationTest : public testing::TestWithParam<Kind> {};

TEST_P(QuantisationTest, FindsTheWordsOfAScalarDescent) {
  const auto [binary, dimension] = GetParam();
  const VocabularyTree tree = test_tree(random_descriptors(binary, 700, dimension, 1), 9);
  const Vocabulary vocabulary = Vocabulary::from_tree(tree);
  const cv::Mat queries = random_descriptors(binary, 500, dimension, 2);
  for (const SimdLevel level : testing_support::simd_levels()) {
    set_simd_level(level);
    const std::vector<WordId> words = vocabulary.words(queries);
    ASSERT_EQ(words.size(), 500U);
    for (int i = 0; i < queries.rows; ++i) {
      std::vector<WordId> expected;
      descend(tree, 0, queries, i, expected);
      EXPECT_THAT(expected, testing::Contains(words[static_cast<std::size_t>(i)])) << "row " << i;
    }
  }
}

// Dimensions of HF-Net, of the shipped network, of ORB and AKAZE, and odd ones with a tail.
INSTANTIATE_TEST_SUITE_P(Kinds, QuantisationTest,
                         testing::Values(Kind{false, 64}, Kind{false, 256}, Kind{false, 37},
                                         Kind{false, 3}, Kind{true, 32}, Kind{true, 61},
                                         Kind{true, 5}),
                         [](const testing::TestParamInfo<Kind>& param) {
                           return (param.param.binary ? "Bytes" : "Floats") +
                                  std::to_string(param.param.dimension);
                         });

TEST(Vocabulary, QuantisesEachRowByItself) {
  const Vocabulary vocabulary =
      Vocabulary::from_tree(test_tree(random_descriptors(false, 300, 64, 3)));
  const cv::Mat queries = random_descriptors(false, 21, 64, 4);  // two groups of eight and a rest
  const std::vector<WordId> together = vocabulary.words(queries);
  for (int i = 0; i < queries.rows; ++i) {
    EXPECT_EQ(vocabulary.words(queries.row(i)).at(0), together[static_cast<std::size_t>(i)]);
  }
  // Rows that do not follow each other in memory.
  cv::Mat wide(21, 80, CV_32F, cv::Scalar(7));
  queries.copyTo(wide.colRange(8, 72));
  EXPECT_EQ(vocabulary.words(wide.colRange(8, 72)), together);
}

TEST(Vocabulary, WeighsWordsByFrequencyTimesIdf) {
  const VocabularyTree tree = test_tree(random_descriptors(false, 100, 16, 5));
  const Vocabulary vocabulary = Vocabulary::from_tree(tree);
  const cv::Mat queries = random_descriptors(false, 80, 16, 6);
  std::map<WordId, double> expected;
  double total = 0.0;
  for (const WordId word : vocabulary.words(queries)) {
    const double weight = 0.5 + 0.25 * (word % 7);  // see test_tree
    expected[word] += weight;
    total += weight;
  }
  const BowVector vector = vocabulary.transform(queries);
  ASSERT_EQ(vector.words.size(), expected.size());
  auto entry = expected.begin();
  for (const auto& [word, value] : vector.words) {
    EXPECT_EQ(word, entry->first);
    EXPECT_NEAR(value, entry->second / total, 1e-6);
    ++entry;
  }
}

TEST(Vocabulary, RecognisesAnImageWhoseDescriptorsAreDisturbed) {
  for (const bool binary : {false, true}) {
    const int dimension = binary ? 32 : 64;
    const Vocabulary vocabulary =
        Vocabulary::from_tree(test_tree(random_descriptors(binary, 2000, dimension, 7), 10));
    const cv::Mat image = random_descriptors(binary, 200, dimension, 8);
    const BowVector same = vocabulary.transform(disturbed(image, binary ? 8 : 0.15, 9));
    const BowVector other = vocabulary.transform(random_descriptors(binary, 200, dimension, 10));
    const BowVector vector = vocabulary.transform(image);
    EXPECT_GT(bow_score(vector, same), 3.0 * bow_score(vector, other));
  }
}

TEST(Vocabulary, RefusesDescriptorsOfAnotherKind) {
  const Vocabulary vocabulary =
      Vocabulary::from_tree(test_tree(random_descriptors(false, 30, 16, 11)));
  EXPECT_TRUE(vocabulary.fits(random_descriptors(false, 2, 16, 1)));
  EXPECT_THROW(vocabulary.words(random_descriptors(false, 2, 17, 1)), ContractError);
  EXPECT_THROW(vocabulary.transform(random_descriptors(true, 2, 16, 1)), ContractError);
  EXPECT_TRUE(vocabulary.transform(cv::Mat()).empty());
}

TEST(Vocabulary, DescribesItself) {
  const Vocabulary vocabulary =
      Vocabulary::from_tree(test_tree(random_descriptors(true, 50, 32, 12), 4));
  const VocabularyInfo info = vocabulary.info();
  EXPECT_EQ(info.name, "test");
  EXPECT_TRUE(info.binary);
  EXPECT_EQ(info.dimension, 32);
  EXPECT_EQ(info.branching, 4);
  EXPECT_EQ(info.words, 50U);
  EXPECT_EQ(vocabulary.word_count(), 50U);
  EXPECT_EQ(vocabulary.word_limit(), 50U);
  EXPECT_TRUE(info.distinct_words);
  EXPECT_FALSE(info.mapped);
  EXPECT_EQ(info.min_weight, 0.5F);
  EXPECT_EQ(info.max_weight, 2.0F);
  EXPECT_GE(info.depth, 3);  // 4 * 4 < 50
}

TEST(VocabularyTree, RefusesTreesThatAreNone) {
  const VocabularyTree good = test_tree(random_descriptors(false, 30, 8, 13));
  const auto refused = [&](const std::function<void(VocabularyTree&)>& change) {
    VocabularyTree tree = good;
    change(tree);
    EXPECT_THROW(Vocabulary::from_tree(tree), ContractError);
  };
  refused([](VocabularyTree& t) { t.nodes[0].children.clear(); });
  refused([](VocabularyTree& t) { t.nodes[1].parent = 5; });
  refused([](VocabularyTree& t) { t.branching = 2; });
  refused([](VocabularyTree& t) { t.nodes.back().weight = -1.0F; });
  refused([](VocabularyTree& t) { t.nodes.back().word = 30; });
  refused([](VocabularyTree& t) { t.nodes.back().children.push_back(1); });
  refused([](VocabularyTree& t) { t.descriptors = t.descriptors.rowRange(0, 3); });
}

}  // namespace
}  // namespace dxslam
