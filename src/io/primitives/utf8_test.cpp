// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/primitives/utf8.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "io/primitives/json_text.h"

namespace dxslam {
namespace {

TEST(Utf8, KeepsEveryCharacter) {
  for (const std::string text : {"", "room", "r\xC3\xA4um", "\xE4\xB8\xAD", "\xF0\x9F\x98\x80"}) {
    EXPECT_EQ(valid_utf8(text), text);
  }
}

TEST(Utf8, ReplacesBytesThatAreNone) {
  const std::string unknown = "\xEF\xBF\xBD";
  EXPECT_EQ(valid_utf8("r\xE4um"), "r" + unknown + "um");              // Latin-1
  EXPECT_EQ(valid_utf8("\xC3"), unknown);                              // cut off
  EXPECT_EQ(valid_utf8("\xC0\xAF"), unknown + unknown);                // longer than needed
  EXPECT_EQ(valid_utf8("\xED\xA0\x80"), unknown + unknown + unknown);  // half a surrogate pair
  EXPECT_EQ(valid_utf8("\xF5x"), unknown + "x");                       // beyond U+10FFFF
}

TEST(JsonText, TakesNamesThatAreNotUtf8) {
  const nlohmann::json json = {{"sequence", "r\xE4um"}};
  const std::string text = to_json_text(json);
  EXPECT_EQ(nlohmann::json::parse(text)["sequence"], valid_utf8("r\xE4um"));
  EXPECT_EQ(text.back(), '\n');
}

TEST(Printable, LeavesNothingThatCommandsATerminal) {
  EXPECT_EQ(printable("a b~\xC3\xA4\xE2\x82\xAC\xF0\x9F\x98\x80"),
            "a b~\xC3\xA4\xE2\x82\xAC\xF0\x9F\x98\x80");
  EXPECT_EQ(printable("\x1B[2Jx\r\n\t\x7F"), "\\x1b[2Jx\\x0d\\n\\x09\\x7f");
  EXPECT_EQ(printable("\xC2\x9B"
                      "2J\xC2\xA0"),
            "\\xc2\\x9b2J\xC2\xA0")
      << "C1 is escape, too";
  EXPECT_EQ(printable("\x9B\xC3"), "\\x9b\\xc3");
  EXPECT_EQ(printable(std::string_view("\0", 1)), "\\x00");
}

}  // namespace
}  // namespace dxslam
