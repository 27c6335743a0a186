// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstddef>
#include <cstdint>

namespace dxslam {

/// CRC-32C (Castagnoli, reflected polynomial 0x82F63B78, as in iSCSI and ext4): finds every change
/// of up to 32 bits in a row. Uses the processor's instruction where it has one.
std::uint32_t crc32c(const void* data, std::size_t size);

/// The same by tables, on any processor.
std::uint32_t crc32c_portable(const void* data, std::size_t size);

}  // namespace dxslam
