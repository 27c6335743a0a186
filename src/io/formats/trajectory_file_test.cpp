// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/formats/trajectory_file.h"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

#include "io/primitives/test_folder.h"

namespace dxslam {
namespace {

StampedPose pose_at(double stamp) {
  return {stamp, SE3::exp((Vector6d() << 1, 2, stamp, 0.1, 0.2, 0.3).finished())};
}

TEST(TrajectoryFile, ReadsBackWhatWasWritten) {
  const TestFolder folder;
  write_trajectory(folder / "t.txt", {pose_at(0.5), pose_at(1.25)});
  const Trajectory again = read_trajectory(folder / "t.txt");
  ASSERT_EQ(again.size(), 2U);
  EXPECT_EQ(again[1].stamp, 1.25);
  EXPECT_LT(translation_distance(again[1].world_from_camera, pose_at(1.25).world_from_camera),
            1e-8);
  EXPECT_LT(rotation_angle(again[1].world_from_camera, pose_at(1.25).world_from_camera), 1e-7);
}

TEST(TrajectoryFile, RefusesBrokenRowsByLine) {
  const TestFolder folder;
  const std::string good = "# head\n1 0 0 0 0 0 0 1\r\n";
  const auto expect = [&](const std::string& row, const std::vector<std::string>& parts) {
    folder.write("t.txt", good + row);
    expect_input_error([&] { read_trajectory(folder / "t.txt"); }, parts);
  };
  expect("2 0 0 0 0 0 1\n", {"t.txt:3", "7 columns", "expected 8"});
  expect("2 0 0 0 0 0 0 1 9\n", {"t.txt:3", "9 columns"});
  expect("2 0 nan 0 0 0 0 1\n", {"t.txt:3", "ty is 'nan'", "finite"});
  expect("inf 0 0 0 0 0 0 1\n", {"t.txt:3", "stamp is 'inf'"});
  expect("2 0 x 0 0 0 0 1\n", {"t.txt:3", "ty is 'x'"});
  expect("0.5 0 0 0 0 0 0 1\n", {"t.txt:3", "stamp 0.5 after 1", "rising"});
  expect("1e300 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1\n", {"t.txt:4", "after 1e+300,"});
  expect("2 0 0 0 0 0 0 0\n", {"t.txt:3", "length 0", "expected 1"});
  expect("2 0 0 0 1 1 0 1", {"t.txt:3", "length 1.73"});
  expect("2 1e200 0 0 0 0 0 1\n", {"t.txt:3", "1e+200", "metres"});
  expect(std::string("2 0\0 0", 6), {"t.txt:3", "binary"});
  folder.write("empty.txt", "# nothing\n");
  expect_input_error([&] { read_trajectory(folder / "empty.txt"); }, {"empty.txt", "no pose"});
}

TEST(TrajectoryWriter, SurvivesAKill) {
  const TestFolder folder;
  const pid_t child = ::fork();
  if (child == 0) {
    TrajectoryWriter writer(folder / "t.txt");
    for (int i = 0; i < 100; ++i) writer.append(pose_at(i));
    ::kill(::getpid(), SIGKILL);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(read_trajectory(folder / "t.txt").size(), 100U);
}

TEST(TrajectoryWriter, ReportsAFullDisk) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "this system has no /dev/full";
  expect_input_error([] { TrajectoryWriter writer("/dev/full"); }, {"/dev/full", "No space left"});
  expect_input_error([] { TrajectoryWriter writer("/nowhere/t.txt"); }, {"No such file"});
}

TEST(TrajectoryWriter, KeepsWholeRowsOnAFullDisk) {
  const TestFolder folder;
  // A limit on the size of files stands for a full disk.
  const pid_t child = ::fork();
  if (child == 0) {
    ::signal(SIGXFSZ, SIG_IGN);
    rlimit limit{};
    ::getrlimit(RLIMIT_FSIZE, &limit);
    const rlimit small{1000, limit.rlim_max};
    TrajectoryWriter writer(folder / "t.txt");
    ::setrlimit(RLIMIT_FSIZE, &small);
    int row = 0;
    try {
      for (; row < 1000; ++row) writer.append(pose_at(row));
    } catch (const InputError&) {
      ::setrlimit(RLIMIT_FSIZE, &limit);
      writer.append(pose_at(row));  // the one that failed
      ::_exit(row);
    }
    ::_exit(0);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_GT(WEXITSTATUS(status), 5);
  EXPECT_EQ(read_trajectory(folder / "t.txt").size(), WEXITSTATUS(status) + std::size_t{1});
}

TEST(TrajectoryFile, IsToldFromThoseOfOthers) {
  const FileKind kind = trajectory_kind();
  const std::string header = "# timestamp tx ty tz qx qy qz qw\n";
  EXPECT_TRUE(kind.matches(header + "1.0 0 0 0 0 0 0 1\n"));
  EXPECT_TRUE(kind.matches(header.substr(0, 9)));
  EXPECT_TRUE(kind.matches("# of an earlier run\n"));
  EXPECT_FALSE(kind.matches("# mine\n1.0 0 0 0 0 0 0 1\n"));
  EXPECT_FALSE(kind.matches("1.0 0 0 0 0 0 0 1\n"));
  EXPECT_FALSE(kind.matches("precious\n"));
}

}  // namespace
}  // namespace dxslam
