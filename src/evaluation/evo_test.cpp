// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors

// Our errors against those of evo, called as a program.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>

#include "evaluation/ate.h"
#include "evaluation/rpe.h"
#include "io/formats/trajectory_file.h"
#include "io/formats/trajectory_reader.h"

namespace dxslam {
namespace {

namespace fs = std::filesystem;

constexpr double kTolerance = 1e-6;

class Evo : public testing::Test {
 protected:
  void SetUp() override {
    programs_ = fs::path(DXSLAM_SOURCE_DIR) / ".venvs/eval/bin";
    if (!fs::exists(programs_ / "evo_ape")) {
      GTEST_SKIP() << programs_ << " has no evo_ape; scripts/setup installs it";
    }
    folder_ = fs::temp_directory_path() / fmt::format("dxslam_evo_{}", ::getpid());
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  // A drifting, scaled, moved copy of a curve, at another rate, with frames missing.
  void make_trajectories() {
    std::mt19937 random(7);
    std::normal_distribution<double> noise(0.0, 1.0);
    const SE3 moved = SE3::exp((Vector6d() << 1.0, -2.0, 0.5, 0.3, -0.8, 1.1).finished());
    Vector6d drift = Vector6d::Zero();
    Trajectory truth;
    Trajectory estimate;
    for (int i = 0; i < 400; ++i) {
      const double t = 0.01 * i;
      const SE3 pose = SE3::exp((Vector6d() << std::sin(t), 0.7 * std::cos(2 * t), 0.1 * t, 0.3 * t,
                                 std::sin(3 * t), 0.2 * t)
                                    .finished());
      truth.push_back({1305031229.0 + t, pose});
      if (i % 3 != 0 || (i > 150 && i < 190)) continue;
      for (int k = 0; k < 6; ++k) drift[k] += 0.003 * noise(random);
      const SE3 drifted = moved * pose * SE3::exp(drift);
      estimate.push_back({1305031229.0 + t + 0.002 * std::abs(noise(random)) / 3.0,
                          SE3(drifted.rotation(), 0.9 * drifted.translation())});
    }
    write_trajectory(truth_file(), truth);
    write_trajectory(estimate_file(), estimate);
    // As written, so that both programs see the same digits.
    truth_ = read_trajectory(truth_file());
    estimate_ = read_trajectory(estimate_file());
  }

  std::string truth_file() const { return (folder_ / "truth.txt").string(); }
  std::string estimate_file() const { return (folder_ / "estimate.txt").string(); }

  // stats.json of a run of evo on the two files.
  nlohmann::json run(const std::string& program, const std::string& arguments,
                     const std::string& format = "tum") {
    const std::string archive = (folder_ / "result.zip").string();
    const std::string command = fmt::format(
        "cd '{}' && HOME='{}' '{}' {} '{}' '{}' {} --save_results '{}' > evo.log 2>&1 && "
        "'{}' -m zipfile -e '{}' result",
        folder_.string(), folder_.string(), (programs_ / program).string(), format, truth_file(),
        estimate_file(), arguments, archive, (programs_ / "python").string(), archive);
    fs::remove_all(archive);
    EXPECT_EQ(std::system(command.c_str()), 0) << command;
    std::ifstream stats(folder_ / "result/stats.json");
    return nlohmann::json::parse(stats);
  }

  static void expect_equal(const ErrorStatistics& ours, const nlohmann::json& theirs) {
    EXPECT_NEAR(ours.rmse, theirs["rmse"], kTolerance);
    EXPECT_NEAR(ours.mean, theirs["mean"], kTolerance);
    EXPECT_NEAR(ours.median, theirs["median"], kTolerance);
    EXPECT_NEAR(ours.std, theirs["std"], kTolerance);
    EXPECT_NEAR(ours.min, theirs["min"], kTolerance);
    EXPECT_NEAR(ours.max, theirs["max"], kTolerance);
  }

  fs::path programs_;
  fs::path folder_;
  Trajectory truth_;
  Trajectory estimate_;
};

TEST_F(Evo, AgreesOnAteForEachAlignment) {
  make_trajectories();
  AteOptions options;
  options.alignment = Alignment::kSe3;
  expect_equal(evaluate_ate(truth_, estimate_, options).position, run("evo_ape", "-a"));
  options.alignment = Alignment::kSim3;
  expect_equal(evaluate_ate(truth_, estimate_, options).position, run("evo_ape", "-as"));
  options.alignment = Alignment::kNone;
  expect_equal(evaluate_ate(truth_, estimate_, options).position, run("evo_ape", ""));
}

TEST_F(Evo, AgreesOnRpe) {
  make_trajectories();
  RpeOptions options;
  RpeReport report = evaluate_rpe(truth_, estimate_, options);
  expect_equal(report.translation, run("evo_rpe", "-d 1 -u f -r trans_part"));
  expect_equal(report.rotation, run("evo_rpe", "-d 1 -u f -r angle_deg"));
  options.delta = 10;
  report = evaluate_rpe(truth_, estimate_, options);
  expect_equal(report.translation, run("evo_rpe", "-d 10 -u f --all_pairs -r trans_part"));
  options.all_pairs = false;
  options.alignment = Alignment::kSim3;
  report = evaluate_rpe(truth_, estimate_, options);
  expect_equal(report.translation, run("evo_rpe", "-d 10 -u f -as -r trans_part"));
}

std::string kitti_rows(const Trajectory& trajectory) {
  std::string text;
  for (const StampedPose& pose : trajectory) {
    const Eigen::Matrix3d r = pose.world_from_camera.rotation().toRotationMatrix();
    const Eigen::Vector3d& t = pose.world_from_camera.translation();
    for (int i = 0; i < 3; ++i) {
      text += fmt::format("{:.12g} {:.12g} {:.12g} {:.12g}{}", r(i, 0), r(i, 1), r(i, 2), t[i],
                          i < 2 ? ' ' : '\n');
    }
  }
  return text;
}

std::string euroc_rows(const Trajectory& trajectory) {
  std::string text = "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], ...\n";
  for (const StampedPose& pose : trajectory) {
    const Eigen::Vector3d& t = pose.world_from_camera.translation();
    const Eigen::Quaterniond& q = pose.world_from_camera.rotation();
    text += fmt::format("{},{:.9f},{:.9f},{:.9f},{:.9f},{:.9f},{:.9f},{:.9f},0,0,0,0,0,0,0,0,0\n",
                        static_cast<std::int64_t>(std::llround(pose.stamp * 1e9)), t.x(), t.y(),
                        t.z(), q.w(), q.x(), q.y(), q.z());
  }
  return text;
}

TEST_F(Evo, AgreesOnFilesOfKittiAndEuroc) {
  make_trajectories();
  truth_.resize(100);
  estimate_.resize(100);
  std::ofstream(truth_file()) << kitti_rows(truth_);
  std::ofstream(estimate_file()) << kitti_rows(estimate_);
  const TrajectoryFile truth = read_trajectory_file(truth_file());
  const TrajectoryFile estimate = read_trajectory_file(estimate_file());
  expect_equal(evaluate_ate(truth.poses, estimate.poses).position, run("evo_ape", "-a", "kitti"));

  make_trajectories();
  std::ofstream(truth_file()) << euroc_rows(truth_);
  const TrajectoryFile euroc = read_trajectory_file(truth_file());
  ASSERT_EQ(euroc.format, TrajectoryFormat::kEuroc);
  expect_equal(evaluate_ate(euroc.poses, estimate_).position, run("evo_ape", "-a", "euroc"));
}

}  // namespace
}  // namespace dxslam
