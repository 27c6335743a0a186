// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace dxslam {

// Numbers in image files. The caller has checked that the bytes are there.

inline std::uint32_t byte_at(std::string_view bytes, std::size_t at) {
  return static_cast<unsigned char>(bytes[at]);
}
inline std::uint32_t big_endian16(std::string_view bytes, std::size_t at) {
  return byte_at(bytes, at) << 8U | byte_at(bytes, at + 1);
}
inline std::uint32_t little_endian16(std::string_view bytes, std::size_t at) {
  return byte_at(bytes, at + 1) << 8U | byte_at(bytes, at);
}
inline std::uint32_t big_endian32(std::string_view bytes, std::size_t at) {
  return big_endian16(bytes, at) << 16U | big_endian16(bytes, at + 2);
}
inline std::uint32_t little_endian32(std::string_view bytes, std::size_t at) {
  return little_endian16(bytes, at + 2) << 16U | little_endian16(bytes, at);
}

}  // namespace dxslam
