// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/primitives/output_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>

#include "io/primitives/file_lock.h"
#include "io/primitives/json_text.h"
#include "io/primitives/test_folder.h"

#include <nlohmann/json.hpp>

namespace dxslam {
namespace {

namespace fs = std::filesystem;

const FileKind kPicture = kind_by_beginning("a drawing", {"<svg "}, {".svg"});

TEST(OutputFile, ReplacesItsOwnKindEmptyFilesAndNothing) {
  const TestFolder folder;
  folder.write("own.svg", "<svg width=\"3\"/>");
  folder.write("empty.svg", "");
  folder.write("photo.svg", "\xFF\xD8");
  for (const char* name : {"own.svg", "empty.svg", "none.svg", "CAPITALS.SVG"}) {
    EXPECT_NO_THROW(require_target(folder / name, kPicture)) << name;
  }
  expect_input_error([&] { require_target(folder / "photo.svg", kPicture); },
                     {"photo.svg", "is not a drawing and is not replaced", "a new name"});
  expect_input_error([&] { require_target(folder / "a.png", kPicture); }, {"a.png", ".svg"});
  expect_input_error([&] { require_target(folder / "none/a.svg", kPicture); }, {"none/a.svg"});
  EXPECT_NO_THROW(require_target("/dev/null", kPicture));
  EXPECT_EQ(folder.read("photo.svg"), "\xFF\xD8");
}

TEST(OutputFile, TellsJsonByItsFirstFields) {
  using Json = nlohmann::ordered_json;
  const FileKind kind = json_kind("a report", {"metric", "unit"});
  const Json object = {{"metric", "ate"}, {"unit", "m"}, {"more", {1, 2}}};
  EXPECT_TRUE(kind.matches(to_json_text(object)));
  EXPECT_TRUE(kind.matches(to_json_text(Json::array({object, object}))));
  EXPECT_TRUE(kind.matches(to_json_text(Json::array())));
  EXPECT_FALSE(kind.matches(to_json_text(Json{{"metric", "ate"}, {"name", "m"}, {"unit", "m"}})));
  EXPECT_FALSE(kind.matches(to_json_text(Json{{"version", 1}})));
  EXPECT_FALSE(kind.matches("metric: ate\nunit: m\n"));
  EXPECT_FALSE(kind.matches("{\n"));
}

TEST(OutputFile, KnowsOneFileUnderTwoNames) {
  const TestFolder folder;
  folder.write("a", "text");
  fs::create_symlink("a", folder / "link");
  fs::create_symlink("new", folder / "to_new");
  fs::create_directory(folder / "in");
  EXPECT_TRUE(is_same_target(folder / "a", folder / "in/../a"));
  EXPECT_TRUE(is_same_target(folder / "a", folder / "link"));
  EXPECT_TRUE(is_same_target(folder / "new", folder / "in/../new"));
  EXPECT_TRUE(is_same_target(folder / "new", folder / "to_new"));
  EXPECT_FALSE(is_same_target(folder / "a", folder / "new"));
  EXPECT_FALSE(is_same_target("/dev/null", "/dev/null"));
}

TEST(FileLock, LetsOneInAtATime) {
  const TestFolder folder;
  const std::string path = folder / "lock";
  {
    const FileLock lock(path, "");
    expect_input_error([&] { FileLock(path, "is taken"); }, {"is taken"});
  }
  EXPECT_FALSE(fs::exists(path));
  folder.write("lock", "");  // of a killed process
  const FileLock lock(path, "is taken");
}

}  // namespace
}  // namespace dxslam
