// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/formats/trajectory_reader.h"

#include "io/formats/trajectory_file.h"

#include "io/primitives/test_folder.h"

namespace dxslam {
namespace {

// Turned by 90 degrees about z, at (1, 2, 3).
void expect_pose(const StampedPose& pose, double stamp) {
  EXPECT_NEAR(pose.stamp, stamp, 1e-6);
  const SE3& p = pose.world_from_camera;
  EXPECT_LT((p.translation() - Eigen::Vector3d(1, 2, 3)).norm(), 1e-9);
  EXPECT_LT((p.rotation() * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm(), 1e-6);
}

TEST(TrajectoryReader, TellsTheFormatByTheColumns) {
  const TestFolder folder;
  const std::string tum =
      folder.write("a.txt", "\xEF\xBB\xBF# c\n1403636579.763556 1 2 3 0 0 0.70710678 0.70710678\n");
  const std::string kitti =
      folder.write("b.txt", "0 -1 0 1 1 0 0 2 0 0 1 3\n0 -1 0 1 1 0 0 2 0 0 1 3\n");
  const std::string euroc =
      folder.write("c.csv",
                   "#timestamp, p_RS_R_x [m], ...\r\n"
                   "1403636579763555584,1,2,3,0.70710678,0,0,0.70710678,0,0,0,0,0,0,0,0,0\r\n");
  const std::string vicon =
      folder.write("d.csv", "1403636579763555584, 1, 2, 3, 0.70710678, 0, 0, 0.70710678\n");
  EXPECT_EQ(read_trajectory_file(tum).format, TrajectoryFormat::kTum);
  EXPECT_EQ(read_trajectory_file(kitti).format, TrajectoryFormat::kKitti);
  for (const std::string& path : {tum, euroc, vicon}) {
    const TrajectoryFile file = read_trajectory_file(path);
    ASSERT_EQ(file.poses.size(), 1U);
    EXPECT_TRUE(file.has_stamps());
    expect_pose(file.poses.front(), 1403636579.763556);
  }
  EXPECT_EQ(read_trajectory_file(vicon).format, TrajectoryFormat::kEuroc);
  const TrajectoryFile file = read_trajectory_file(kitti);
  ASSERT_EQ(file.poses.size(), 2U);
  EXPECT_FALSE(file.has_stamps());
  expect_pose(file.poses[1], 1.0);
}

TEST(TrajectoryReader, CanBeToldTheFormat) {
  const TestFolder folder;
  const std::string path = folder.write("a.txt", "7 1 2 3 0.70710678 0 0 0.70710678\n");
  expect_pose(read_trajectory_file(path, "euroc").poses.front(), 7e-9);
  expect_input_error([&] { read_trajectory_file(path, "kitti"); },
                     {"a.txt:1: 8 columns, expected 12 (KITTI"});
  expect_input_error([&] { read_trajectory_file(path, "ros"); },
                     {"'ros'", "auto, tum, kitti, euroc"});
}

TEST(TrajectoryReader, RefusesInOneSentence) {
  const TestFolder folder;
  const auto expect = [&](const std::string& text, const std::vector<std::string>& parts) {
    const std::string path = folder.write("t.txt", text);
    expect_input_error([&] { read_trajectory_file(path); }, parts);
  };
  expect("", {"t.txt", "no pose"});
  expect("1 2 3\n", {"t.txt:1: 3 columns", "8 (TUM", "12 (KITTI", "17 (EuRoC"});
  expect("1,5 0,1 0,2 0,3 0 0 0 1,0\n", {"t.txt:1", "decimal commas"});
  expect("1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0\n", {"t.txt:2: 4 columns, expected 12"});
  expect("2 0 0 0 0 1 0 0 0 0 1 0\n", {"t.txt:1", "orthonormal"});
  expect("1403636579763555584,1,2,3,0.5,0,0,0\n", {"t.txt:1", "quaternion of length 0.5"});
  expect("2 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n", {"t.txt:2", "rising stamps"});
}

// A stamp cannot stand for two poses: which of them the truth is compared with was left to chance.
TEST(TrajectoryReader, LeavesOutStampsThatComeAgain) {
  const TestFolder folder;
  const std::string path = folder.write(
      "t.txt", "1 0 0 0 0 0 0 1\n1 9 0 0 0 0 0 1\n1 8 0 0 0 0 0 1\n1.1 1 0 0 0 0 0 1\n");
  const TrajectoryFile file = read_trajectory_file(path);
  ASSERT_EQ(file.poses.size(), 2U);
  EXPECT_EQ(file.poses[0].world_from_camera.translation().x(), 0.0);
  EXPECT_THAT(file.hints, testing::ElementsAre(testing::HasSubstr("2 of 4 poses")));
  EXPECT_EQ(read_trajectory(path).size(), 2U);
}

TEST(TrajectoryReader, GivesAHintAboutStampsThatAreNoSeconds) {
  const TestFolder folder;
  std::string text;
  for (int i = 0; i < 4; ++i) {
    text += "14036365797" + std::to_string(63555584 + 50000000 * i) + ".0 0 0 0 0 0 0 1\n";
  }
  const TrajectoryFile file = read_trajectory_file(folder.write("t.txt", text));
  EXPECT_EQ(file.format, TrajectoryFormat::kTum);
  EXPECT_THAT(file.hints, testing::ElementsAre(testing::HasSubstr("nanoseconds")));
}

}  // namespace
}  // namespace dxslam
