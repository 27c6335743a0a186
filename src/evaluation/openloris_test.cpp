// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "evaluation/openloris.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "evaluation/association.h"
#include "io/recordings/openloris_sensors.h"

namespace dxslam {
namespace {

using testing::HasSubstr;

// A curve in space over `seconds`, ten poses per second.
Trajectory curve(double begin, double seconds) {
  Trajectory trajectory;
  for (int i = 0; i <= static_cast<int>(std::lround(10 * seconds)); ++i) {
    const double t = 0.1 * i;
    trajectory.push_back({begin + t, SE3::exp((Vector6d() << 2 * std::cos(t), std::sin(2 * t),
                                               0.1 * t, 0.1 * t, 0.2, 0)
                                                  .finished())});
  }
  return trajectory;
}

OpenlorisResult result_of(const std::vector<Trajectory>& sequences,
                          const std::string& frame = "base_link") {
  OpenlorisResult result;
  result.scene = "home";
  result.frame = frame;
  int number = 1;
  for (const Trajectory& poses : sequences)
    result.sequences.push_back({number++, false, poses, {}});
  return result;
}

Trajectory between(const Trajectory& trajectory, double first, double last) {
  Trajectory part;
  for (const StampedPose& pose : trajectory) {
    if (pose.stamp > first - 1e-6 && pose.stamp < last + 1e-6) part.push_back(pose);
  }
  return part;
}

Trajectory moved(const Trajectory& trajectory, const SE3& motion) {
  return transformed(trajectory, Sim3(motion));
}

const SE3 kMotion = SE3::exp((Vector6d() << 3, 2, 1, 0.4, -1.0, 2.0).finished());

OpenlorisOptions within(double metres, double degrees) {
  OpenlorisOptions options;
  options.max_position_error = metres;
  options.max_angle_error = degrees;
  return options;
}

TEST(Openloris, IsPerfectForAMovedCopy) {
  const std::vector<Trajectory> truth = {curve(100, 20), curve(500, 10)};
  const auto report = evaluate_openloris(
      result_of(truth), result_of({moved(truth[0], kMotion), moved(truth[1], kMotion)}),
      within(0.01, 0.1));
  ASSERT_EQ(report.sequences.size(), 2U);
  EXPECT_LT((report.truth_from_estimate.rigid() * kMotion).log().norm(), 1e-8);
  for (const OpenlorisSequenceReport& sequence : report.sequences) {
    EXPECT_LT(sequence.position.max, 1e-8);
    EXPECT_LT(sequence.angle.max, 1e-4);
    EXPECT_NEAR(sequence.correct_rate, 1.0, 1e-9);
    EXPECT_NEAR(sequence.tracked_rate, 1.0, 1e-9);
    EXPECT_EQ(sequence.relocalization_score, 1.0);
    EXPECT_EQ(sequence.start_delay, 0.0);
  }
  EXPECT_NEAR(report.totals.correct_rate, 1.0, 1e-9);
}

TEST(Openloris, CountsTimeWithPosesAndStartsTheClockWithTheTruth) {
  const Trajectory truth = curve(0, 20);
  Trajectory estimate = between(truth, 2.0, 5.0);  // Lost from 5 to 8, then to the end at 18.
  const Trajectory later = between(truth, 8.0, 18.0);
  estimate.insert(estimate.end(), later.begin(), later.end());
  const auto report =
      evaluate_openloris(result_of({truth}), result_of({estimate}), within(0.1, 1.0));
  const OpenlorisSequenceReport& sequence = report.sequences.front();
  // Three seconds, one more before the system counts as lost, ten, and again one.
  EXPECT_NEAR(sequence.correct_rate, 15.0 / 20.0, 1e-9);
  EXPECT_NEAR(sequence.correct_rate_once_started, 15.0 / 18.0, 1e-9);
  EXPECT_NEAR(sequence.start_delay, 2.0, 1e-9);
  EXPECT_NEAR(*sequence.relocalization_score, std::exp(-2.0 / 60.0), 1e-9);
}

TEST(Openloris, JudgesLaterSequencesInTheFrameOfTheFirst) {
  const std::vector<Trajectory> truth = {curve(0, 20), curve(100, 10), curve(200, 10)};
  const SE3 off = SE3(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0, 2, 0));
  const auto estimate =
      result_of({truth[0], moved(truth[1], off), between(truth[2], 206.0, 210.0)});
  auto report = evaluate_openloris(result_of(truth), estimate, within(1.0, 30.0));
  EXPECT_NEAR(report.sequences[1].position.rmse, 2.0, 1e-9);
  EXPECT_EQ(report.sequences[1].correct_rate, 0.0);
  EXPECT_NEAR(report.sequences[1].tracked_rate, 1.0, 1e-9);
  EXPECT_EQ(report.sequences[1].correct_position.count, 0U);
  EXPECT_EQ(report.sequences[1].relocalization_score, 0.0);
  EXPECT_NEAR(report.sequences[2].correct_rate, 0.4, 1e-9);
  EXPECT_NEAR(report.totals.correct_rate, 24.0 / 40.0, 1e-9);
  EXPECT_NEAR(report.totals.tracked_rate, 34.0 / 40.0, 1e-9);
  EXPECT_NEAR(report.totals.position, 2.0 * 101 / (201 + 101 + 41), 1e-9);
  EXPECT_LT(report.totals.correct_position, 1e-9);

  report = evaluate_openloris(result_of(truth), estimate, within(2.1, 30.0));
  EXPECT_NEAR(report.sequences[1].correct_rate, 1.0, 1e-9);
}

TEST(Openloris, AWrongAngleIsWrong) {
  const Trajectory truth = curve(0, 10);
  Trajectory estimate = truth;
  const SE3 turn(Eigen::Quaterniond(Eigen::AngleAxisd(0.6, Eigen::Vector3d::UnitX())),
                 Eigen::Vector3d::Zero());
  for (StampedPose& pose : estimate) pose.world_from_camera = pose.world_from_camera * turn;
  const auto score = [&](double degrees) {
    return evaluate_openloris(result_of({truth}), result_of({estimate}), within(1.0, degrees))
        .totals.correct_rate;
  };
  EXPECT_EQ(score(34.0), 0.0);
  EXPECT_NEAR(score(35.0), 1.0, 1e-9);  // 0.6 rad are 34.4 degrees.
}

TEST(Openloris, MovesTheTruthToTheSensor) {
  const Trajectory truth = curve(0, 10);
  for (const std::string& frame : openloris_frames()) {
    const SE3 base_from_sensor = openloris_base_from_sensor(false, frame);
    Trajectory estimate = truth;
    for (StampedPose& pose : estimate) {
      pose.world_from_camera = kMotion * pose.world_from_camera * base_from_sensor;
    }
    const auto report = evaluate_openloris(result_of({truth}), result_of({estimate}, frame));
    EXPECT_LT(report.totals.position, 1e-8) << frame;
    EXPECT_LT(report.sequences[0].angle.max, 1e-4) << frame;
  }
  EXPECT_THROW(evaluate_openloris(result_of({truth}), result_of({truth}, "d400_nose")), InputError);
}

TEST(Openloris, AbsentSequencesAreNotTheSameAsEmptyOnes) {
  const std::vector<Trajectory> truth = {curve(0, 10), curve(100, 30)};
  const auto absent = evaluate_openloris(result_of(truth), result_of({truth[0]}));
  EXPECT_FALSE(absent.sequences[1].present);
  EXPECT_NEAR(absent.totals.correct_rate, 0.25, 1e-9);
  EXPECT_NEAR(absent.totals.correct_rate_present, 1.0, 1e-9);
  const auto empty = evaluate_openloris(result_of(truth), result_of({truth[0], {}}));
  EXPECT_TRUE(empty.sequences[1].present);
  EXPECT_NEAR(empty.totals.correct_rate_present, 0.25, 1e-9);
  EXPECT_EQ(empty.sequences[1].relocalization_score, 0.0);
  EXPECT_TRUE(std::isinf(empty.sequences[1].start_delay));
}

TEST(Openloris, LeavesOutRepeatedPosesAndGapsOfTheTruth) {
  Trajectory truth = curve(0, 10);
  truth.erase(truth.begin() + 31, truth.begin() + 60);  // 3.1 to 5.9 s
  Trajectory estimate = curve(0, 10);
  estimate.insert(estimate.begin() + 80, {7.95, estimate[79].world_from_camera});
  const auto report = evaluate_openloris(result_of({truth}), result_of({estimate}));
  EXPECT_EQ(report.sequences[0].poses, 101U);
  EXPECT_EQ(report.sequences[0].errors.size(), 101U - 29U);
}

TEST(Openloris, ASystemThatIsToldItsPlaceHasNoRelocalizationScore) {
  const Trajectory truth = curve(0, 10);
  OpenlorisResult estimate = result_of({truth});
  estimate.sequences[0].aided = true;
  EXPECT_FALSE(evaluate_openloris(result_of({truth}), estimate).sequences[0].relocalization_score);
}

TEST(Openloris, FitsScaleOnlyWhenAsked) {
  const Trajectory truth = curve(0, 10);
  const auto estimate =
      result_of({transformed(truth, Sim3(0.5, kMotion.rotation(), kMotion.translation()))});
  EXPECT_GT(evaluate_openloris(result_of({truth}), estimate).totals.position, 0.1);
  OpenlorisOptions options;
  options.with_scale = true;
  const auto report = evaluate_openloris(result_of({truth}), estimate, options);
  EXPECT_LT(report.totals.position, 1e-8);
  EXPECT_NEAR(report.truth_from_estimate.scale(), 2.0, 1e-9);
}

TEST(Openloris, AlignsAFirstSequenceOfOnePoseOrNone) {
  const std::vector<Trajectory> truth = {curve(0, 10), curve(100, 10)};
  const Trajectory second = moved(truth[1], kMotion);
  const auto one = evaluate_openloris(
      result_of(truth), result_of({moved({truth[0][20]}, kMotion), second}), within(0.01, 1));
  EXPECT_NEAR(one.sequences[0].correct_rate, 0.1, 1e-9);
  EXPECT_NEAR(one.sequences[1].correct_rate, 1.0, 1e-9);
  const auto none = evaluate_openloris(result_of(truth), result_of({{}, second}), within(0.01, 1));
  EXPECT_EQ(none.totals.correct_rate, 0.0);
  EXPECT_NEAR(none.sequences[1].tracked_rate, 1.0, 1e-9);
}

TEST(Openloris, RefusesWhatDoesNotBelongTogether) {
  const OpenlorisResult truth = result_of({curve(0, 10)});
  OpenlorisResult other = truth;
  other.scene = "cafe";
  EXPECT_THROW(evaluate_openloris(truth, other), InputError);
  other = truth;
  other.sequences[0].number = 7;
  try {
    evaluate_openloris(truth, other);
    FAIL();
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), HasSubstr("sequence 7 of scene home has no truth"));
  }
  EXPECT_THROW(evaluate_openloris(result_of({{}}), truth), InputError);
}

TEST(Interpolate, MovesEvenlyBetweenThePosesAround) {
  const SE3 a(Eigen::Quaterniond::Identity(), Eigen::Vector3d(1, 0, 0));
  const SE3 b(Eigen::Quaterniond(Eigen::AngleAxisd(1.0, Eigen::Vector3d::UnitZ())),
              Eigen::Vector3d(3, 4, 0));
  const Trajectory two = {{10.0, a}, {10.4, b}};
  const auto middle = interpolate(two, 10.1, 0.5);
  ASSERT_TRUE(middle);
  EXPECT_LT((middle->translation() - Eigen::Vector3d(1.5, 1, 0)).norm(), 1e-9);
  EXPECT_NEAR(rotation_angle(a, *middle), 0.25, 1e-9);
  EXPECT_TRUE(interpolate(two, 10.0, 0.5));
  EXPECT_TRUE(interpolate(two, 10.4, 0.5));
  EXPECT_FALSE(interpolate(two, 9.99, 0.5));
  EXPECT_FALSE(interpolate(two, 10.41, 0.5));
  EXPECT_FALSE(interpolate(two, 10.1, 0.4));
  EXPECT_FALSE(interpolate({}, 10.0, 0.5));
}

}  // namespace
}  // namespace dxslam
