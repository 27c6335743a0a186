// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace dxslam {

/// Whether unpack_tiff_block() knows this value of the tag Compression: 1 none, 5 LZW, 8 and 32946
/// Deflate, 32773 PackBits.
bool tiff_compression_known(std::uint32_t compression);

/// Fills the whole of `block` from the bytes of one strip or tile; false if these are damaged or
/// hold less. What they hold beyond that is left.
bool unpack_tiff_block(std::uint32_t compression, std::string_view packed,
                       std::vector<std::uint8_t>& block);

}  // namespace dxslam
