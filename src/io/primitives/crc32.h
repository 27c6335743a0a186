// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstdint>
#include <string_view>

namespace dxslam {

/// CRC-32 as in zip, PNG and MCAP. `before`: of the bytes before these.
std::uint32_t crc32_of(std::string_view bytes, std::uint32_t before = 0);

}  // namespace dxslam
