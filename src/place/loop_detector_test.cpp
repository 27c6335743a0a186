// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "place/loop_detector.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"

namespace dxslam {
namespace {

BowVector words(const std::vector<WordId>& ids) {
  std::vector<std::pair<WordId, float>> entries;
  for (const WordId id : ids) entries.emplace_back(id, 1.0F);
  return make_bow_vector(entries);
}

// Unit vector in the plane.
std::vector<float> direction(double degrees) {
  const double a = degrees * M_PI / 180.0;
  return {static_cast<float>(std::cos(a)), static_cast<float>(std::sin(a)), 0.0F};
}

double chord(double degrees) { return 2.0 * std::sin(0.5 * degrees * M_PI / 180.0); }

LoopDetectorOptions options_for(const std::string& method) {
  LoopDetectorOptions options;
  options.method = method;
  options.candidates = 20;
  options.min_relative_score = 0.0;
  options.min_score_orb = options.min_score_hf = options.min_score_global = 0.8;
  options.max_distance = options.max_distance_paper = options.max_distance_global = 0.3;
  options.min_inliers_orb = options.min_inliers_hf = 30;
  return options;
}

// The most similar place by words (10) looks different as a whole; 11 shares half of the words and
// looks the same; 12 looks the same but shares no word.
LoopDetector make_detector(const LoopDetectorOptions& options) {
  LoopDetector detector(options);
  detector.add(10, words({1, 2, 3, 9}), direction(80));
  detector.add(11, words({1, 2, 7, 8}), direction(10));
  detector.add(12, words({20, 21}), direction(1));
  return detector;
}
const std::vector<WordId> kQueryWords = {1, 2, 3, 4};

std::vector<LoopCandidate> query(LoopDetector& detector, const PlaceExclusion& excluded = {},
                                 const LoopVerifier& verify = {}) {
  return detector.detect(words(kQueryWords), direction(0), excluded, verify);
}

TEST(LoopDetector, TakesTheTopPlaceByWords) {
  for (const char* method : {"orb-bow", "hf-bow"}) {
    LoopDetector detector = make_detector(options_for(method));
    const auto candidates = query(detector);
    ASSERT_EQ(candidates.size(), 2U) << method;
    EXPECT_EQ(candidates[0].id, 10U);
    EXPECT_NEAR(candidates[0].bow_score, 1.5, 1e-6);
    EXPECT_NEAR(candidates[0].global_distance, chord(80), 1e-6);
    EXPECT_TRUE(candidates[0].accepted());
    EXPECT_EQ(candidates[1].verdict, LoopVerdict::kOutranked);
  }
}

TEST(LoopDetector, TakesTheNearestGlobalDescriptorOfThoseSimilarByWords) {
  for (const char* method : {"hf-bow-global", "hf-bow-global-paper"}) {
    LoopDetector detector = make_detector(options_for(method));
    const auto candidates = query(detector);
    ASSERT_EQ(candidates.size(), 2U);  // not 12, which no word leads to
    EXPECT_EQ(candidates[0].id, 11U);
    EXPECT_NEAR(candidates[0].global_distance, chord(10), 1e-6);
    EXPECT_TRUE(candidates[0].accepted());
  }
  LoopDetectorOptions only_the_first = options_for("hf-bow-global-paper");
  only_the_first.candidates = 1;
  LoopDetector narrow = make_detector(only_the_first);
  const auto one = query(narrow);
  ASSERT_EQ(one.size(), 1U);
  EXPECT_EQ(one[0].id, 10U);
  EXPECT_EQ(one[0].verdict, LoopVerdict::kFarGlobal);
}

TEST(LoopDetector, AsksBothLevelsToAgree) {
  LoopDetectorOptions options = options_for("hf-bow-global");
  LoopDetector agreed = make_detector(options);
  EXPECT_NEAR(query(agreed)[0].confidence, 1.0, 1e-6);  // the score of words
  options.min_score_global = 1.2;                       // place 11 has 1.0
  LoopDetector words_too_few = make_detector(options);
  EXPECT_EQ(query(words_too_few)[0].verdict, LoopVerdict::kLowScore);
  options = options_for("hf-bow-global");
  options.max_distance = 0.1;
  LoopDetector too_far = make_detector(options);
  EXPECT_EQ(query(too_far)[0].verdict, LoopVerdict::kFarGlobal);
  EXPECT_LT(query(too_far)[0].confidence, 0.0);  // below all that are near enough
}

TEST(LoopDetector, NeedsNoWordsForGlobalOnly) {
  LoopDetector detector = make_detector(options_for("global-only"));
  const auto candidates = detector.detect({}, direction(0));
  ASSERT_EQ(candidates.size(), 3U);
  EXPECT_EQ(candidates[0].id, 12U);
  EXPECT_EQ(candidates[1].id, 11U);
  EXPECT_TRUE(candidates[0].accepted());
  EXPECT_EQ(candidates[0].bow_score, 0.0);
}

TEST(LoopDetector, LooksAtNoPlaceFarLessAlikeByWords) {
  LoopDetectorOptions options = options_for("hf-bow-global");
  LoopDetector all = make_detector(options);
  EXPECT_EQ(query(all)[0].id, 11U);
  options.min_relative_score = 0.7;  // 11 has two thirds of the score of 10
  LoopDetector detector = make_detector(options);
  const auto candidates = query(detector);
  ASSERT_EQ(candidates.size(), 1U);
  EXPECT_EQ(candidates[0].id, 10U);
}

TEST(LoopDetector, FindsNoExcludedPlace) {
  for (const char* method : {"hf-bow", "hf-bow-global", "global-only"}) {
    LoopDetector detector = make_detector(options_for(method));
    for (const LoopCandidate& c : query(detector, [](std::uint32_t id) { return id != 10; })) {
      EXPECT_EQ(c.id, 10U) << method;
    }
    EXPECT_THAT(query(detector, [](std::uint32_t) { return true; }), testing::IsEmpty());
  }
}

TEST(LoopDetector, SaysWhichThresholdRefused) {
  LoopDetectorOptions strict = options_for("hf-bow");
  strict.min_score_hf = 1.6;
  LoopDetector by_words = make_detector(strict);
  EXPECT_EQ(query(by_words)[0].verdict, LoopVerdict::kLowScore);
  strict = options_for("global-only");
  strict.max_distance_global = 0.01;
  LoopDetector by_global = make_detector(strict);
  EXPECT_EQ(query(by_global)[0].verdict, LoopVerdict::kFarGlobal);
}

TEST(LoopDetector, LetsGeometryDecide) {
  LoopDetector detector = make_detector(options_for("hf-bow+geometry"));
  const auto better = query(detector, {}, [](std::uint32_t id) { return id == 11 ? 40 : 12; });
  EXPECT_EQ(better[0].id, 11U);
  EXPECT_EQ(better[0].inliers, 40);
  EXPECT_TRUE(better[0].accepted());
  const auto none = query(detector, {}, [](std::uint32_t) { return 29; });
  EXPECT_EQ(none[0].verdict, LoopVerdict::kFewInliers);
  EXPECT_THROW(query(detector), ContractError);
}

TEST(LoopDetector, WaitsForQueriesInARowThatAgree) {
  LoopDetectorOptions options = options_for("hf-bow");
  options.consistent_queries = 3;
  options.consistent_distance = 1;
  LoopDetector detector = make_detector(options);
  const auto find = [&](std::uint32_t id) {
    return query(detector, [id](std::uint32_t other) { return other != id; })[0].verdict;
  };
  EXPECT_EQ(find(10), LoopVerdict::kInconsistent);
  EXPECT_EQ(find(11), LoopVerdict::kInconsistent);
  EXPECT_EQ(find(10), LoopVerdict::kAccepted);
  query(detector, [](std::uint32_t) { return true; });  // nothing found: starts anew
  EXPECT_EQ(find(10), LoopVerdict::kInconsistent);
}

TEST(LoopDetector, RefusesOptionsThatMeanNothing) {
  LoopDetectorOptions options;
  options.method = "hf";
  EXPECT_THROW(LoopDetector{options}, InputError);
  options = {};
  options.candidates = 0;
  EXPECT_THROW(LoopDetector{options}, InputError);
  for (const std::string& name : loop_method_names()) EXPECT_EQ(parse_loop_method(name).name, name);
}

TEST(PlaceDatabase, ForgetsRemovedPlaces) {
  PlaceDatabase places;
  places.add(7, words({1}), {});
  places.add(8, words({1, 2}), direction(20));
  places.add(9, words({2}), direction(50));
  EXPECT_THROW(places.add(9, {}, {}), ContractError);
  EXPECT_THROW(places.add(5, {}, {1.0F}), ContractError);
  EXPECT_FALSE(places.globals().contains(7));
  places.remove(7);
  places.remove(100);
  EXPECT_EQ(places.size(), 2U);
  EXPECT_NEAR(places.globals().compare(8, direction(0)).distance(), chord(20), 1e-6);
  EXPECT_NEAR(places.globals().compare(9, direction(0)).distance(), chord(50), 1e-6);
  EXPECT_THROW(places.globals().compare(7, direction(0)), ContractError);
  places.remove(8);
  const auto nearest = places.globals().query(direction(0), 5);
  ASSERT_EQ(nearest.size(), 1U);
  EXPECT_EQ(nearest[0].id, 9U);
  ASSERT_EQ(places.by_words(words({1, 2}), 5).size(), 1U);
  places.add(7, words({1}), direction(1));
  EXPECT_EQ(places.globals().query(direction(0), 1)[0].id, 7U);
}

}  // namespace
}  // namespace dxslam
