// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "map_files/crc32c.h"

#include <gtest/gtest.h>

#include <random>
#include <string>

namespace dxslam {
namespace {

// RFC 3720, B.4.
TEST(Crc32c, GivesThePublishedChecksums) {
  std::string rising(32, '\0');
  for (std::size_t i = 0; i < rising.size(); ++i) rising[i] = static_cast<char>(i);
  for (const auto checksum : {crc32c, crc32c_portable}) {
    EXPECT_EQ(checksum("123456789", 9), 0xE3069283U);
    EXPECT_EQ(checksum(std::string(32, '\0').data(), 32), 0x8A9136AAU);
    EXPECT_EQ(checksum(std::string(32, '\xFF').data(), 32), 0x62A8AB43U);
    EXPECT_EQ(checksum(rising.data(), 32), 0x46DD794EU);
    EXPECT_EQ(checksum("", 0), 0U);
  }
}

TEST(Crc32c, IsTheSameWithAndWithoutTheInstruction) {
  std::mt19937 random(1);
  std::string bytes(300, '\0');
  for (char& byte : bytes) byte = static_cast<char>(random());
  for (std::size_t offset = 0; offset < 9; ++offset) {
    for (std::size_t size = 0; size + offset <= bytes.size(); ++size) {
      ASSERT_EQ(crc32c(&bytes[offset], size), crc32c_portable(&bytes[offset], size));
    }
  }
}

}  // namespace
}  // namespace dxslam
