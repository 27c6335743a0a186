// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstdint>
#include <string_view>

namespace dxslam {

// What reader and writer of MCAP must agree on (mcap.dev/spec).

/// The first bytes of a file, and its last.
inline constexpr std::string_view kMcapMagic("\x89MCAP0\r\n", 8);

/// Operation codes of the records that are read or written here.
enum class McapOp : std::uint8_t {
  kHeader = 1,
  kFooter = 2,
  kSchema = 3,
  kChannel = 4,
  kMessage = 5,
  kChunk = 6,
  kMessageIndex = 7,
  kChunkIndex = 8,
  kStatistics = 11,
  kSummaryOffset = 14,
  kDataEnd = 15
};

}  // namespace dxslam
