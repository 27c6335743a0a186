// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/primitives/text_file.h"

#include <cmath>
#include <filesystem>

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

TEST(TextFile, ReadsFilesRowByRow) {
  const TestFolder folder;
  std::string text = "\xEF\xBB\xBF# head\r\n";
  for (int i = 0; i < 20000; ++i) text += std::to_string(i) + " a b\r\n";
  const std::string path = folder.write("long.txt", text + "last");
  int rows = 0;
  std::string last;
  for_each_row(path, "a list", [&](const TextRow& row) {
    EXPECT_EQ(row.line, ++rows + 1);
    last = row.text;
  });
  EXPECT_EQ(rows, 20001);
  EXPECT_EQ(last, "last");
}

TEST(TextFile, KeepsTheRestOfALine) {
  const auto rows = parse_table("1.0,  my rgb/a,b c.png  \n2.0\n", "f");
  EXPECT_EQ(rows[0].rest(1), "my rgb/a,b c.png");
  EXPECT_EQ(rows[0].rest(2), "rgb/a,b c.png");
  EXPECT_EQ(rows[1].rest(1), "");
}

TEST(TextFile, LimitsWhatIsReadAtOnce) {
  const TestFolder folder;
  const std::string line(limits::kTextLineBytes + 100000, '1');
  expect_input_error(
      [&] { for_each_row(folder.write("line", "1\n" + line), "a list", [](const TextRow&) {}); },
      {"line:2", "a line of more than 4194304 bytes"});
  expect_input_error([&] { read_table(folder.write("matrix", line), "a 3x3 matrix"); },
                     {"matrix", "3x3", "at most 1048576 bytes"});
}

TEST(TextFile, NamesDecimalCommasAndSemicolons) {
  for (const char* text : {"0,5 1,25", "1305031102,1753 rgb/1.png", "1;2,5", "-0,5\t1"}) {
    EXPECT_TRUE(has_decimal_commas(text)) << text;
  }
  for (const char* text : {"0, 1, 2", "1,2,3", "1.0,a b", "0.5 1.25", "1,a.png", "a,1 b", "1,5"}) {
    EXPECT_FALSE(has_decimal_commas(text)) << text;
  }
  const auto refuse = [](const char* text) {
    refuse_columns("f", parse_table(text, "f").front(), "2");
  };
  expect_input_error([&] { refuse("0,5 1,25"); }, {"f:1: 4 columns, expected 2", "decimal commas"});
  expect_input_error([&] { refuse("1;2"); }, {"1 columns", "semicolons"});
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
  expect_input_error([] { parse_table("# head\r1 2\r3 4\r", "f"); }, {"f:1", "carriage returns"});
  expect_input_error(
      [] {
        parse_table(
            "\xFF\xFE"
            "1",
            "f");
      },
      {"f:1", "UTF-16"});
  expect_input_error([&] { read_file(folder / "no", "a list"); }, {"no", "no such file", "a list"});
  expect_input_error([&] { read_file(folder.path(), "a list"); }, {"not a regular file"});
  std::filesystem::create_symlink("ring", folder / "ring");
  expect_input_error([&] { read_table(folder / "ring", "a list"); }, {"ring", "symbolic links"});
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
