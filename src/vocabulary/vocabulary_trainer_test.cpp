// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "vocabulary/vocabulary_trainer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>
#include <set>

#include "io/primitives/test_folder.h"
#include "vocabulary/descriptor_clustering.h"
#include "vocabulary/test_vocabularies.h"

namespace dxslam {
namespace {

DescriptorTraits traits_of(bool binary) {
  DescriptorTraits traits;
  traits.binary = binary;
  traits.dimension = binary ? 32 : 64;
  traits.max_distance = binary ? 60.0F : 0.7F;
  return traits;
}

// Features whose scores fall with the row.
Features features_of(const cv::Mat& descriptors) {
  Features features;
  features.descriptors = descriptors.clone();
  for (int i = 0; i < descriptors.rows; ++i) {
    features.keypoints.push_back({0.0F, 0.0F, 1.0F / static_cast<float>(i + 1), 1.0F});
  }
  return features;
}

// A walk along a row of things: image i sees things i * 10 to i * 10 + 59, each a little different
// every time.
struct Walk {
  explicit Walk(bool binary_things, int things = 400)
      : binary(binary_things), all(random_descriptors(binary, things, binary ? 32 : 64, 1)) {}
  Features image(int i) const {
    const cv::Mat seen = all.rowRange(i * 10, i * 10 + 60);
    return features_of(disturbed(seen, binary ? 6 : 0.2, static_cast<unsigned>(100 + i)));
  }
  int images() const { return (all.rows - 60) / 10 + 1; }
  bool binary;
  cv::Mat all;
};

VocabularyTrainingOptions options_for(const std::string& method, int words = 0) {
  VocabularyTrainingOptions options;
  options.method = method;
  options.words = words;
  return options;
}

Vocabulary train(const Walk& walk, const VocabularyTrainingOptions& options) {
  VocabularyTrainer trainer(traits_of(walk.binary), options);
  for (int i = 0; i < walk.images(); ++i) trainer.add(walk.image(i));
  return trainer.finish("walk");
}

class IncrementalTrainingTest : public testing::TestWithParam<bool> {};

TEST_P(IncrementalTrainingTest, GivesEachThingOneWord) {
  const Walk walk(GetParam());
  const Vocabulary vocabulary = train(walk, options_for("incremental"));
  // The first and the last ten are seen in one image only, which is too few for a word.
  EXPECT_EQ(vocabulary.word_count(), 380U);
  const std::vector<WordId> words = vocabulary.words(walk.all.rowRange(10, 390));
  EXPECT_GE(std::set<WordId>(words.begin(), words.end()).size(), 370U);
}

INSTANTIATE_TEST_SUITE_P(Kinds, IncrementalTrainingTest, testing::Bool(),
                         [](const testing::TestParamInfo<bool>& param) {
                           return param.param ? "Bytes" : "Floats";
                         });

TEST(IncrementalTraining, JoinsOnlyTheBestMatchedOfAnImage) {
  const cv::Mat things = random_descriptors(false, 50, 64, 2);
  VocabularyTrainingOptions options = options_for("incremental");
  options.matched_per_image = 20;
  VocabularyTrainer trainer(traits_of(false), options);
  for (int i = 0; i < 3; ++i) trainer.add(features_of(things));
  EXPECT_EQ(trainer.open_words(), 50U);  // the others open no new words either
  const Vocabulary vocabulary = trainer.finish("best");
  EXPECT_EQ(vocabulary.word_count(), 20U);
  // Those with the highest scores, which are the first rows.
  const std::vector<WordId> words = vocabulary.words(things.rowRange(0, 20));
  EXPECT_EQ(std::set<WordId>(words.begin(), words.end()).size(), 20U);
}

TEST(IncrementalTraining, CarriesAWordOnWhereItsMatchWasNotAmongTheBest) {
  const cv::Mat things = random_descriptors(false, 2, 64, 3);
  VocabularyTrainingOptions options = options_for("incremental");
  options.matched_per_image = 1;
  options.min_observations = 1;
  VocabularyTrainer trainer(traits_of(false), options);
  Features features = features_of(things);
  trainer.add(features);
  trainer.add(features);  // thing 1 is passed over
  std::swap(features.keypoints[0].score, features.keypoints[1].score);
  trainer.add(features);  // now thing 0 is
  EXPECT_EQ(trainer.open_words(), 2U);
}

TEST(IncrementalTraining, MatchesNothingAcrossSequences) {
  const cv::Mat things = random_descriptors(false, 30, 64, 4);
  VocabularyTrainer trainer(traits_of(false), options_for("incremental"));
  trainer.add(features_of(things));
  trainer.start_sequence();
  trainer.add(features_of(things));
  EXPECT_EQ(trainer.open_words(), 60U);
}

TEST(IncrementalTraining, KeepsMemoryBoundedAndTheWordsSeenMost) {
  VocabularyTrainingOptions options = options_for("incremental");
  options.max_open_words = 1000;
  VocabularyTrainer trainer(traits_of(false), options);
  const cv::Mat lasting = random_descriptors(false, 50, 64, 5);
  for (unsigned i = 0; i < 40; ++i) {
    cv::Mat image = lasting.clone();
    image.push_back(random_descriptors(false, 100, 64, 1000 + i));  // never seen again
    trainer.add(features_of(image));
    EXPECT_LE(trainer.open_words(), 1000U + 150U);
  }
  EXPECT_EQ(trainer.finish("lasting").word_count(), 50U);
}

TEST(IncrementalTraining, GroupsWordsWhereThereIsALimit) {
  const Walk walk(false);
  EXPECT_EQ(train(walk, options_for("incremental", 100)).word_count(), 100U);
}

TEST(KmeansTraining, MakesAsManyWordsAsAskedFor) {
  const Walk walk(false);
  EXPECT_EQ(train(walk, options_for("kmeans", 123)).word_count(), 123U);
  VocabularyTrainingOptions options = options_for("kmeans");
  options.branching = 4;
  options.depth = 3;
  const Vocabulary vocabulary = train(walk, options);
  EXPECT_LE(vocabulary.word_count(), 64U);
  EXPECT_GT(vocabulary.word_count(), 50U);
  EXPECT_EQ(vocabulary.info().depth, 3);
}

TEST(KmeansTraining, FindsTheClusters) {
  const Walk walk(true);
  const Vocabulary vocabulary = train(walk, options_for("kmeans", 400));
  const cv::Mat again = disturbed(walk.all, 6, 77);
  const std::vector<WordId> first = vocabulary.words(walk.all);
  const std::vector<WordId> second = vocabulary.words(again);
  int same = 0;
  for (std::size_t i = 0; i < first.size(); ++i) same += first[i] == second[i] ? 1 : 0;
  EXPECT_GT(same, 240);
}

TEST(VocabularyTraining, WeighsWordsByTheirRarity) {
  // Two things: one in each of 9 images, the other in one of three.
  const cv::Mat things = random_descriptors(false, 2, 64, 6);
  VocabularyTrainer trainer(traits_of(false), options_for("kmeans", 2));
  for (int i = 0; i < 9; ++i) {
    trainer.add(features_of(i % 3 == 0 ? things : things.rowRange(0, 1)));
  }
  const VocabularyInfo info = trainer.finish("idf").info();
  EXPECT_NEAR(info.min_weight, 0.0, 1e-6);  // ln(10 / 10)
  EXPECT_NEAR(info.max_weight, std::log(10.0 / 4.0), 1e-6);
}

TEST(VocabularyTraining, GoesOnFromACheckpointAsIfNothingHadHappened) {
  for (const bool binary : {false, true}) {
    const TestFolder folder;
    const Walk walk(binary);
    train(walk, options_for("incremental")).save(folder / "whole.fbow");
    VocabularyTrainer first(traits_of(binary), options_for("incremental"));
    for (int i = 0; i < 15; ++i) first.add(walk.image(i));
    first.save(folder / "state", "walk", 15);
    VocabularyTrainer second(traits_of(binary), options_for("incremental"));
    ASSERT_EQ(second.load(folder / "state", "walk"), 15U);
    EXPECT_EQ(second.images(), 15U);
    for (int i = 15; i < walk.images(); ++i) second.add(walk.image(i));
    second.finish("walk").save(folder / "resumed.fbow");
    EXPECT_EQ(folder.read("resumed.fbow"), folder.read("whole.fbow"));
  }
}

TEST(VocabularyTraining, RefusesForeignAndDamagedCheckpoints) {
  const TestFolder folder;
  const Walk walk(false);
  VocabularyTrainer trainer(traits_of(false), options_for("incremental"));
  trainer.add(walk.image(0));
  const std::string path = folder / "state";
  trainer.save(path, "walk", 1);
  expect_input_error([&] { trainer.load(path, "run"); }, {path, "'walk'", "'run'"});
  VocabularyTrainer other(traits_of(true), options_for("incremental"));
  expect_input_error([&] { other.load(path, "walk"); }, {path, "descriptors"});
  std::string bytes = folder.read("state");
  for (std::size_t at = 0; at < bytes.size(); at += 1009) {
    std::string damaged = bytes;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x20);
    folder.write("state", damaged);
    expect_input_error([&] { trainer.load(path, "walk"); }, {path});
  }
  folder.write("state", bytes.substr(0, bytes.size() / 2));
  expect_input_error([&] { trainer.load(path, "walk"); }, {path});
}

TEST(VocabularyTraining, NeedsSomethingToSee) {
  VocabularyTrainer trainer(traits_of(false), options_for("incremental"));
  expect_input_error([&] { trainer.finish("none"); }, {"0 images gave 0 words"});
  trainer.add(Features());
  expect_input_error([&] { trainer.finish("none"); }, {"1 images gave 0 words"});
  VocabularyTrainingOptions options;
  options.branching = 1;
  EXPECT_THROW(VocabularyTrainer(traits_of(false), options), InputError);
  options = options_for("magic");
  EXPECT_THROW(VocabularyTrainer(traits_of(false), options), InputError);
}

TEST(ImageSample, IsEvenAndWithinItsLimit) {
  ImageSample sample(100 * 64 * 4 * 10);  // ten images of a hundred rows
  for (int i = 0; i < 1000; ++i) sample.add(cv::Mat(100, 64, CV_32F, cv::Scalar(i)));
  ASSERT_GE(sample.images().size(), 5U);
  ASSERT_LE(sample.images().size(), 10U);
  for (std::size_t i = 0; i < sample.images().size(); ++i) {
    EXPECT_EQ(sample.images()[i].at<float>(0, 0), static_cast<float>(i * sample.stride()));
  }
}

TEST(WordTree, HasEachDescriptorAsAWordUnlessLimited) {
  for (const bool binary : {false, true}) {
    const cv::Mat rows = random_descriptors(binary, 333, 32, 7);
    const Vocabulary vocabulary = Vocabulary::from_tree(test_tree(rows, 7));
    const std::vector<WordId> words = vocabulary.words(rows);
    // k-means leaves every row with the nearest centre, so each finds its way back to itself.
    EXPECT_EQ(std::set<WordId>(words.begin(), words.end()).size(), 333U);
  }
}

TEST(WordTree, TakesEqualDescriptorsForOneWord) {
  cv::Mat rows = random_descriptors(false, 3, 16, 8);
  rows.push_back(rows.clone());
  EXPECT_EQ(Vocabulary::from_tree(test_tree(rows, 2)).word_count(), 3U);
  const cv::Mat one = random_descriptors(true, 1, 16, 9);
  EXPECT_EQ(Vocabulary::from_tree(test_tree(one, 2)).word_count(), 1U);
}

TEST(Clustering, SeparatesGroups) {
  for (const bool binary : {false, true}) {
    const cv::Mat centres = random_descriptors(binary, 4, 64, 10);
    cv::Mat rows;
    for (unsigned i = 0; i < 25; ++i) rows.push_back(disturbed(centres, binary ? 20 : 0.3, i));
    std::mt19937_64 random(1);
    const Clustering clusters = cluster_descriptors(rows, {}, 4, 20, random);
    ASSERT_EQ(clusters.centres.rows, 4);
    for (int i = 0; i < rows.rows; ++i) {
      EXPECT_EQ(clusters.label[static_cast<std::size_t>(i)],
                clusters.label[static_cast<std::size_t>(i % 4)]);
    }
  }
}

TEST(Clustering, CountsRowsByTheirWeight) {
  const cv::Mat rows = random_descriptors(false, 2, 8, 11);
  std::mt19937_64 random(1);
  const cv::Mat centre = cluster_descriptors(rows, {1.0F, 1000.0F}, 1, 3, random).centres;
  EXPECT_LT(cv::norm(centre.row(0), rows.row(1)), 0.01);
}

}  // namespace
}  // namespace dxslam
