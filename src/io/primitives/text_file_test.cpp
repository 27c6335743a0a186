// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/primitives/text_file.h"

#include <cmath>

#include "io/primitives/test_folder.h"

namespace dxslam {
namespace {

TEST(TextFile, ParsesRowsWithTheirLineNumbers) {
  const auto rows = parse_table("\xEF\xBB\xBF# head\r\n\r\n 1.5\tb.png \r\n2,c\n3", "f");
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[0].line, 3);
  EXPECT_THAT(rows[0].fields, testing::ElementsAre("1.5", "b.png"));
  EXPECT_THAT(rows[1].fields, testing::ElementsAre("2", "c"));
  EXPECT_EQ(rows[2].line, 5);
}

TEST(TextFile, NumbersMustBeWhole) {
  EXPECT_EQ(parse_number("-1.5e3"), -1500.0);
  EXPECT_EQ(parse_number("+2"), 2.0);
  EXPECT_TRUE(std::isnan(*parse_number("nan")));
  for (const char* text : {"", "1.5x", " 1", "0x10", "1,5", "++1", "1e999"}) {
    EXPECT_EQ(parse_number(text), std::nullopt) << text;
  }
}

TEST(TextFile, RefusesBinaryDataMissingFilesAndFolders) {
  const TestFolder folder;
  expect_input_error([] { parse_table(std::string("a\n\0b", 4), "f"); }, {"f:2", "binary"});
  expect_input_error([&] { read_file(folder / "no", "a list"); }, {"no", "no such file", "a list"});
  expect_input_error([&] { read_file(folder.path(), "a list"); }, {"not a regular file"});
  folder.write("big", std::string(100, 'x'));
  expect_input_error([&] { read_file(folder / "big", "a list", 99); }, {"100 bytes", "99"});
}

TEST(TextFile, QuotesWhatIsFitToPrint) {
  EXPECT_EQ(in_quotes("a\x01\xff."), std::string("'a") + "?" + "?" + ".'");
  EXPECT_EQ(in_quotes(std::string(61, 'a')), "'" + std::string(60, 'a') + "...'");
}

TEST(TextFile, FindsTheNearestName) {
  EXPECT_EQ(nearest_name("min_inlier", {"max_inliers", "min_inliers"}), "min_inliers");
  EXPECT_EQ(nearest_name("completely_else", {"min_inliers"}), "");
}

}  // namespace
}  // namespace dxslam
