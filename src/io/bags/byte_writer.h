// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

namespace dxslam {

/// Appends little-endian numbers and strings: what ByteReader reads.
class ByteWriter {
 public:
  template <class Number>
  ByteWriter& number(Number value) {
    static_assert(std::is_arithmetic_v<Number>);
    char raw[sizeof(Number)];
    std::memcpy(raw, &value, sizeof(Number));
    bytes_.append(raw, sizeof(Number));
    return *this;
  }
  ByteWriter& raw(std::string_view bytes) {
    bytes_.append(bytes);
    return *this;
  }
  /// Behind its 32-bit length.
  ByteWriter& string(std::string_view text) {
    number(static_cast<std::uint32_t>(text.size()));
    return raw(text);
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

}  // namespace dxslam
