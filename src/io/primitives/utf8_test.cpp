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

}  // namespace
}  // namespace dxslam
