// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/primitives/scratch_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/magic.h>
#include <sys/vfs.h>

#include <cstdlib>
#include <filesystem>
#include <set>
#include <utility>

#include "core/error.h"
#include "io/primitives/test_folder.h"

namespace dxslam {
namespace {

namespace fs = std::filesystem;

// What the open files of this process are called; those without a name are "... (deleted)".
std::set<std::string> open_files() {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator("/proc/self/fd")) {
    std::error_code error;
    names.insert(fs::read_symlink(entry.path(), error).string());
  }
  return names;
}

// Where a file is made that is told nothing but the environment.
std::string place_of_file(const std::string& tmpdir) {
  const char* before = std::getenv("TMPDIR");
  const std::string kept = before == nullptr ? "" : before;
  ::setenv("TMPDIR", tmpdir.c_str(), 1);
  const std::set<std::string> others = open_files();
  ScratchFile file;
  EXPECT_TRUE(file.write("x", 1, 0));
  std::string place;
  for (const std::string& name : open_files()) {
    if (others.count(name) == 0 && name.ends_with(" (deleted)")) place = name;
  }
  before == nullptr ? ::unsetenv("TMPDIR") : ::setenv("TMPDIR", kept.c_str(), 1);
  return place;
}

bool is_in_memory(const std::string& folder) {
  struct statfs status{};
  return ::statfs(folder.c_str(), &status) != 0 || status.f_type == TMPFS_MAGIC;
}

TEST(ScratchFile, GivesBackWhatWasWritten) {
  const TestFolder folder;
  ScratchFile file(folder.path());
  EXPECT_TRUE(file.write("there", 5, 100000));
  EXPECT_TRUE(file.write("here", 4, 0));
  EXPECT_TRUE(fs::is_empty(folder.path()));  // not even while it lives
  ScratchFile moved(std::move(file));
  std::string text(5, ' ');
  moved.read(text.data(), 5, 100000);
  EXPECT_EQ(text, "there");
  EXPECT_THROW(moved.read(text.data(), 5, 200000), InputError);
}

TEST(ScratchFile, SaysWhereItCannotWrite) {
  EXPECT_FALSE(ScratchFile("/nowhere/at/all").write("x", 1, 0));
}

// A file in memory bounds no memory.
TEST(ScratchFile, IsOnADisk) {
  const TestFolder folder;
  if (is_in_memory("/var/tmp")) GTEST_SKIP() << "/var/tmp is in memory";
  for (const char* other : {"", "/nowhere", "/dev/shm"}) {
    if (*other == '/' && fs::exists(other) && !is_in_memory(other)) continue;
    EXPECT_THAT(place_of_file(other), testing::StartsWith("/var/tmp/")) << other;
  }
  if (!is_in_memory(folder.path())) {
    EXPECT_THAT(place_of_file(folder.path()), testing::StartsWith(folder.path()));
  }
}

}  // namespace
}  // namespace dxslam
