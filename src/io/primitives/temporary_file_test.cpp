// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/primitives/temporary_file.h"

#include <sys/wait.h>

#include <set>

#include "io/primitives/atomic_file.h"
#include "io/primitives/test_folder.h"

namespace dxslam {
namespace {

std::set<std::string> names_in(const std::string& folder) {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    names.insert(entry.path().filename().string());
  }
  return names;
}

// What a process leaves that is killed while it writes a named temporary file.
void leave_one_for(const std::string& target) {
  const pid_t child = ::fork();
  if (child == 0) {
    TemporaryFile file(target, TemporaryFile::Kind::kNamed);
    file.write("half");
    ::_exit(0);
  }
  ASSERT_EQ(::waitpid(child, nullptr, 0), child);
}

TEST(TemporaryFile, NamedOnesAreWholeOrNotThere) {
  const TestFolder folder;
  for (const auto kind : {TemporaryFile::Kind::kAny, TemporaryFile::Kind::kNamed}) {
    folder.write("f", "old");
    {
      TemporaryFile file(folder / "f", kind);
      file.write("new");
      EXPECT_EQ(folder.read("f"), "old");
    }
    EXPECT_EQ(names_in(folder.path()), std::set<std::string>{"f"});
    TemporaryFile file(folder / "f", kind);
    file.write("ne");
    file.write("w");
    file.publish();
    EXPECT_EQ(folder.read("f"), "new");
    EXPECT_EQ(names_in(folder.path()), std::set<std::string>{"f"});
  }
}

TEST(TemporaryFile, NamesCannotBeGuessed) {
  const TestFolder folder;
  std::set<std::string> all;
  for (int i = 0; i < 20; ++i) {
    leave_one_for(folder / "f");
    all = names_in(folder.path());
  }
  EXPECT_EQ(all.size(), 20U);
}

TEST(TemporaryFile, WhatTheKilledLeftIsRemovedButNothingElse) {
  const TestFolder folder;
  const std::set<std::string> kept = {"f",
                                      "f.tmp",
                                      "f.dxslam-.tmp",
                                      "f.dxslam-abcdefghabcdefg.tmp",
                                      "f.dxslam-abcdefghabcdefgh",
                                      "f.dxslam-abcdefghabcdefg1.tmp",
                                      "f.dxslam-abcdefghabcdefgh.tmp.old"};
  for (const std::string& name : kept) folder.write(name, "x");
  for (int i = 0; i < 3; ++i) leave_one_for(folder / "f");
  leave_one_for(folder / "g");
  const TemporaryFile in_use(folder / "f", TemporaryFile::Kind::kNamed);
  ASSERT_EQ(names_in(folder.path()).size(), kept.size() + 5);
  remove_stale_temporaries(folder / "f");
  EXPECT_EQ(names_in(folder.path()).size(), kept.size() + 2) << "that of g and the one in use stay";
  make_folder(folder.path());
  EXPECT_EQ(names_in(folder.path()).size(), kept.size() + 1);
  for (const std::string& name : kept) EXPECT_EQ(folder.read(name), "x") << name;
  remove_stale_temporaries(folder / "none/f");
}

}  // namespace
}  // namespace dxslam
