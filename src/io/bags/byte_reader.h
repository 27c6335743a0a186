// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstdint>
#include <cstring>
#include <string_view>
#include <type_traits>

#include "core/error.h"

namespace dxslam {

/// Reads little-endian numbers and strings one after another; what goes beyond the end throws
/// InputError. The bytes must outlive the reader.
class ByteReader {
 public:
  ByteReader(std::string_view bytes, std::string_view where) : bytes_(bytes), where_(where) {}

  template <class Number>
  Number number() {
    static_assert(std::is_arithmetic_v<Number>);
    Number value;
    std::memcpy(&value, take(sizeof(Number)).data(), sizeof(Number));
    return value;
  }
  std::string_view take(std::uint64_t count) {
    if (count > bytes_.size() - at_) {
      throw InputError(std::string(where_) + ": ends within a record, expected " +
                       std::to_string(count) + " more bytes at byte " + std::to_string(at_));
    }
    const std::string_view taken = bytes_.substr(at_, count);
    at_ += count;
    return taken;
  }
  /// A string behind its 32-bit length.
  std::string_view string() { return take(number<std::uint32_t>()); }
  bool at_end() const { return at_ == bytes_.size(); }
  std::size_t position() const { return at_; }
  std::size_t left() const { return bytes_.size() - at_; }

 private:
  std::string_view bytes_;
  std::string_view where_;
  std::size_t at_ = 0;
};

}  // namespace dxslam
