// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/primitives/input_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "io/primitives/test_folder.h"

namespace dxslam {
namespace {

TEST(InputFile, IsOpenAndKnowsItsSize) {
  const TestFolder folder;
  folder.write("file", "12345");
  const InputFile file(folder / "file", "a number");
  EXPECT_EQ(file.size(), 5U);
  char bytes[5] = {};
  EXPECT_EQ(::pread(file.descriptor(), bytes, 5, 0), 5);
  EXPECT_EQ(std::string(bytes, 5), "12345");
  EXPECT_EQ(file.read(bytes, 2), 2U);
  EXPECT_EQ(file.read(bytes, 9), 3U);
  EXPECT_EQ(std::string(bytes, 3), "345");
}

TEST(InputFile, WhatIsNoFileIsRefusedAtOnce) {
  const TestFolder folder;
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  const auto refused = [&](const std::string& name, const std::string& why) {
    expect_input_error([&] { InputFile(folder / name, "a number"); },
                       {name + ": " + why, "a number"});
  };
  refused("pipe", "not a regular file");
  refused("", "not a regular file");
  refused("none", "no such file");
}

}  // namespace
}  // namespace dxslam
