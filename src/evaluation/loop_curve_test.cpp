// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "evaluation/loop_curve.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "evaluation/loop_truth_from_poses.h"
#include "evaluation/mat_file.h"
#include "io/primitives/test_folder.h"

namespace dxslam {
namespace {

// Frames 5, 6, 7 and 8 are back at frame 0, 1, 2 and 3; frame 9 nearly.
LoopTruth small_truth() {
  LoopTruth truth(10);
  for (std::size_t i = 0; i < 4; ++i) truth.set(5 + i, i, PairTruth::kSame);
  truth.set(9, 4, PairTruth::kUnclear);
  return truth;
}

TEST(LoopCurve, CountsRightAndWrongGuessesByFallingConfidence) {
  const LoopCurve curve =
      evaluate_loops({{7, 0, 0.5}, {5, 0, 0.9}, {6, 1, 0.8}, {8, 3, 0.4}}, small_truth(), 4);
  ASSERT_EQ(curve.points.size(), 4U);
  EXPECT_DOUBLE_EQ(curve.points[1].recall, 0.5);
  EXPECT_DOUBLE_EQ(curve.points[2].precision, 2.0 / 3.0);
  EXPECT_DOUBLE_EQ(curve.points[3].precision, 0.75);
  EXPECT_DOUBLE_EQ(curve.points[3].recall, 0.75);
  EXPECT_DOUBLE_EQ(curve.recall_at_100_precision, 0.5);
  EXPECT_DOUBLE_EQ(curve.confidence_at_100_precision, 0.8);
  EXPECT_DOUBLE_EQ(curve.average_precision, 0.25 + 0.25 + 0.25 * 0.75);
}

TEST(LoopCurve, AcceptsGuessesOfEqualConfidenceTogether) {
  const LoopCurve curve = evaluate_loops({{5, 0, 0.9}, {6, 1, 0.8}, {7, 0, 0.8}}, small_truth(), 4);
  ASSERT_EQ(curve.points.size(), 2U);
  EXPECT_DOUBLE_EQ(curve.recall_at_100_precision, 0.25);
}

TEST(LoopCurve, DoesNotJudgeUnclearPairs) {
  const LoopCurve curve = evaluate_loops({{9, 4, 0.95}, {5, 0, 0.9}}, small_truth(), 4);
  ASSERT_EQ(curve.points.size(), 1U);
  EXPECT_DOUBLE_EQ(curve.points[0].precision, 1.0);
  EXPECT_DOUBLE_EQ(curve.recall_at_100_precision, 0.25);
}

TEST(LoopCurve, IsEmptyWhereTheSurestGuessIsWrong) {
  const LoopCurve curve = evaluate_loops({{5, 1, 0.9}, {6, 1, 0.8}}, small_truth(), 4);
  EXPECT_DOUBLE_EQ(curve.recall_at_100_precision, 0.0);
  EXPECT_TRUE(std::isinf(curve.confidence_at_100_precision));
  EXPECT_DOUBLE_EQ(evaluate_loops({}, small_truth(), 4).average_precision, 0.0);
}

TEST(LoopCurve, RefusesGuessesThatCannotBe) {
  EXPECT_THROW(evaluate_loops({{10, 1, 0.5}}, small_truth(), 4), ContractError);
  EXPECT_THROW(evaluate_loops({{5, 0, std::nan("")}}, small_truth(), 4), ContractError);
  EXPECT_THROW(evaluate_loops({{5, 0, 0.5}}, small_truth(), 0), ContractError);
}

TEST(LoopCurve, CountsQueriesWithALoopAmongTheReferences) {
  const LoopTruth truth = small_truth();
  EXPECT_EQ(count_queries_with_loop(truth, {5, 6, 7, 8, 9}, {0, 1, 2, 3, 4}), 4U);
  EXPECT_EQ(count_queries_with_loop(truth, {5, 7, 9}, {1, 2}), 1U);
  EXPECT_EQ(count_queries_with_loop(truth, {0, 1}, {5, 6}), 0U);  // they come later
}

TEST(LoopCurve, HasNoRecallWithoutATrueLoop) {
  const LoopCurve curve = evaluate_loops({{9, 1, 0.9}}, small_truth(), 0);
  ASSERT_EQ(curve.points.size(), 1U);
  EXPECT_EQ(curve.points.front().precision, 0.0);
  EXPECT_TRUE(std::isnan(curve.points.front().recall));
  EXPECT_TRUE(std::isnan(curve.recall_at_100_precision));
  EXPECT_TRUE(std::isnan(curve.average_precision));
  const std::string svg = draw_loop_curves_svg({{"a", curve}}, "title");
  EXPECT_THAT(svg, testing::HasSubstr("no true loop"));
  EXPECT_THAT(svg, testing::Not(testing::HasSubstr("nan")));
}

TEST(LoopCurve, DrawsEachCurveWithItsName) {
  const LoopCurve curve = evaluate_loops({{5, 0, 0.9}, {7, 0, 0.5}}, small_truth(), 4);
  const std::string svg = draw_loop_curves_svg({{"a<b", curve}, {"empty", {}}}, "title");
  EXPECT_THAT(svg, testing::StartsWith("<svg"));
  EXPECT_THAT(svg, testing::HasSubstr("a&lt;b"));
  EXPECT_THAT(svg, testing::HasSubstr("recall 0.250 at 100 %"));
  EXPECT_THAT(svg, testing::HasSubstr("empty"));
}

// Published match counts on City Centre; each row's largest entry is the guess. The figures are
// those of the tables they come from.
TEST(LoopCurve, ReproducesPublishedRecallOnCityCentre) {
  const std::string folder = shared_data("lcd_groundtruth");
  if (folder.empty()) GTEST_SKIP() << "the shared ground-truth matrices are absent";
  const LoopTruth truth = read_loop_truth(folder + "/GT/city_GT_final.mat");
  std::vector<std::size_t> all(truth.frames());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
  const std::size_t loops = count_queries_with_loop(truth, all, all);
  EXPECT_EQ(loops, 551U);
  const std::pair<const char*, double> published[] = {{"cc_LPM.mat", 0.7078},
                                                      {"cc_MAGSAC++.mat", 0.6407}};
  for (const auto& [file, recall] : published) {
    std::vector<LoopGuess> best(truth.frames());
    read_mat(
        folder + "/data/" + file, [](const MatShape&) {},
        [&](std::size_t row, std::size_t column, double count) {
          if (count > best[row].confidence) best[row] = {row, column, count};
        });
    best.erase(std::remove_if(best.begin(), best.end(),
                              [](const LoopGuess& guess) { return guess.confidence == 0.0; }),
               best.end());
    EXPECT_NEAR(evaluate_loops(best, truth, loops).recall_at_100_precision, recall, 5e-5) << file;
  }
}

TEST(LoopTruthFromPoses, AsksForDistanceAngleAndTime) {
  const auto pose = [](double stamp, double x, double degrees) {
    return StampedPose{stamp,
                       SE3(so3_exp({0.0, degrees * M_PI / 180.0, 0.0}), Eigen::Vector3d(x, 0, 0))};
  };
  const Trajectory poses = {pose(0, 0.0, 0), pose(1, 0.1, 0), pose(5, 0.4, 25), pose(6, 0.4, 35),
                            pose(7, 0.6, 0), pose(8, 1.2, 0), pose(9, 0.0, 61)};
  PoseLoopOptions options;
  options.radius = 0.5;
  options.angle = 30.0;
  options.window = 4.0;
  options.unclear = 2.0;
  const LoopTruth truth = loop_truth_from_poses(poses, {0, 1, 2, 3, 4, 5, 6}, 8, options);
  EXPECT_EQ(truth.at(1, 0), PairTruth::kDifferent);  // too soon
  EXPECT_EQ(truth.at(2, 0), PairTruth::kSame);
  EXPECT_EQ(truth.at(3, 0), PairTruth::kUnclear);    // turned too far
  EXPECT_EQ(truth.at(4, 0), PairTruth::kUnclear);    // a little far off
  EXPECT_EQ(truth.at(5, 0), PairTruth::kDifferent);  // far off
  EXPECT_EQ(truth.at(6, 0), PairTruth::kDifferent);  // turned away
  EXPECT_EQ(truth.at(7, 0), PairTruth::kUnclear);    // no pose
  options.unclear = 1.0;
  EXPECT_EQ(loop_truth_from_poses(poses, {0, 1, 2, 3, 4, 5, 6}, 8, options).at(4, 0),
            PairTruth::kDifferent);
}

}  // namespace
}  // namespace dxslam
