// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/formats/trajectory_file.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <csignal>

#include "io/primitives/atomic_file.h"
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
  expect("0.5 0 0 0 0 0 0 1\n", {"t.txt:3", "0.500000 after 1.000000", "rising"});
  expect("2 0 0 0 0 0 0 0\n", {"t.txt:3", "length 0", "expected 1"});
  expect("2 0 0 0 1 1 0 1", {"t.txt:3", "length 1.73"});
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

TEST(AtomicFile, KeepsTheOldFileWhenWritingFails) {
  const TestFolder folder;
  write_file_atomically(folder / "f", "old");
  // A limit on the size of files stands for a full disk.
  const pid_t child = ::fork();
  if (child == 0) {
    ::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{1000, 1000};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    try {
      write_file_atomically(folder / "f", std::string(5000, 'x'));
    } catch (const InputError& e) {
      ::_exit(std::string(e.what()).find("cannot be written") != std::string::npos ? 0 : 2);
    }
    ::_exit(1);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  EXPECT_EQ(folder.read("f"), "old");
  const std::filesystem::directory_iterator files(folder.path());
  EXPECT_EQ(std::distance(begin(files), end(files)), 1) << "a temporary file was left behind";
}

TEST(AtomicFile, ClearsUpAfterThoseWhoWereKilled) {
  const TestFolder folder;
  const pid_t child = ::fork();
  if (child == 0) ::_exit(0);
  ASSERT_EQ(::waitpid(child, nullptr, 0), child);
  const std::string dead = std::to_string(child);
  const std::string alive = std::to_string(::getpid());
  const std::vector<std::string> kept = {"f",
                                         "f." + alive + ".0.tmp",
                                         "f." + dead + ".tmp",
                                         "f." + dead + ".0.tmp.old",
                                         "f.-" + dead + ".0.tmp",
                                         "g." + dead + ".0.tmp",
                                         "f.x." + dead + ".0.tmp"};
  for (const std::string& name : kept) folder.write(name, "x");
  folder.write("f." + dead + ".0.tmp", "x");
  folder.write("f." + dead + ".17.tmp", "x");
  remove_stale_temporaries(folder / "f");
  for (const std::string& name : kept) EXPECT_EQ(folder.read(name), "x") << name;
  const std::filesystem::directory_iterator files(folder.path());
  EXPECT_EQ(std::distance(begin(files), end(files)), static_cast<long>(kept.size()));
  remove_stale_temporaries(folder / "none/f");
}

TEST(AtomicFile, WritesThroughLinksAndToDevices) {
  const TestFolder folder;
  folder.write("target", "old");
  std::filesystem::create_symlink("target", folder / "link");
  write_file_atomically(folder / "link", "new");
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
  EXPECT_EQ(folder.read("target"), "new");
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  const int reader = ::open((folder / "pipe").c_str(), O_RDONLY | O_NONBLOCK);
  write_file_atomically(folder / "pipe", "text");
  char text[8] = {};
  EXPECT_EQ(::read(reader, text, sizeof text), 4);
  ::close(reader);
  EXPECT_TRUE(std::filesystem::is_fifo(folder / "pipe"));
  expect_input_error([&] { write_file_atomically(folder.path(), "x"); }, {"cannot be written"});
}

TEST(AtomicFile, ReplacesAndNamesWhatFailed) {
  const TestFolder folder;
  write_file_atomically(folder / "f", "old");
  write_file_atomically(folder / "f", "newer");
  EXPECT_EQ(folder.read("f"), "newer");
  expect_input_error([&] { write_file_atomically(folder / "no/f", "x"); },
                     {"no/f", "cannot be written", "No such file"});
}

}  // namespace
}  // namespace dxslam
