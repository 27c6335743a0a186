// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/image_codecs/tiff_compression.h"

#include <zlib.h>

#include <algorithm>
#include <cstring>

namespace dxslam {
namespace {

constexpr std::uint32_t kNone = 1;
constexpr std::uint32_t kLzw = 5;
constexpr std::uint32_t kDeflate = 8;
constexpr std::uint32_t kOldDeflate = 32946;
constexpr std::uint32_t kPackBits = 32773;

bool copy(std::string_view packed, std::vector<std::uint8_t>& block) {
  if (packed.size() < block.size()) return false;
  std::copy_n(packed.begin(), block.size(), block.begin());
  return true;
}

bool inflate_all(std::string_view packed, std::vector<std::uint8_t>& block) {
  z_stream stream{};
  if (inflateInit(&stream) != Z_OK) return false;
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
  stream.avail_in = static_cast<uInt>(packed.size());
  stream.next_out = block.data();
  stream.avail_out = static_cast<uInt>(block.size());
  const int result = inflate(&stream, Z_FINISH);
  inflateEnd(&stream);
  return (result == Z_STREAM_END || result == Z_BUF_ERROR) && stream.avail_out == 0;
}

// A signed byte n: the next n + 1 bytes as they are, or 1 - n times the next byte.
bool unpack_bits(std::string_view packed, std::vector<std::uint8_t>& block) {
  std::size_t from = 0;
  std::size_t to = 0;
  while (to < block.size()) {
    if (from + 1 >= packed.size()) return false;
    const int n = static_cast<signed char>(packed[from++]);
    if (n == -128) continue;
    const std::size_t wanted = static_cast<std::size_t>(n < 0 ? 1 - n : n + 1);
    const std::size_t count = std::min(wanted, block.size() - to);
    if (n < 0) {
      std::fill_n(&block[to], count, static_cast<std::uint8_t>(packed[from++]));
    } else {
      if (count > packed.size() - from) return false;
      std::copy_n(packed.begin() + static_cast<std::ptrdiff_t>(from), count, &block[to]);
      from += wanted;
    }
    to += count;
  }
  return true;
}

/// Codes of 9 to 12 bits, highest bit first. A code stands for the bytes of an earlier place in
/// the output: those of the code before it and one more.
class Lzw {
 public:
  Lzw(std::string_view packed, std::vector<std::uint8_t>& block) : packed_(packed), out_(block) {}

  bool unpack() {
    std::size_t previous = kNoPlace;  // where the last code's bytes begin
    std::size_t previous_length = 0;
    while (to_ < out_.size()) {
      const std::uint32_t code = next_code();
      if (code == kEnd) return false;
      if (code == kClear) {
        next_ = kFirst;
        previous = kNoPlace;
        continue;
      }
      if (previous != kNoPlace && next_ < kMostCodes) {
        places_[next_] = static_cast<std::uint32_t>(previous);
        lengths_[next_++] = static_cast<std::uint32_t>(previous_length + 1);
      }
      const std::size_t begin = to_;
      if (!put(code)) return false;
      previous = begin;
      previous_length = to_ - begin;
    }
    return true;
  }

 private:
  static constexpr std::uint32_t kClear = 256;
  static constexpr std::uint32_t kEnd = 257;
  static constexpr std::uint32_t kFirst = 258;
  static constexpr std::uint32_t kMostCodes = 4096;
  static constexpr std::size_t kNoPlace = ~std::size_t{0};

  std::uint32_t next_code() {
    // The width grows one code early, which is how TIFF writes it.
    const int width = next_ >= 2047 ? 12 : next_ >= 1023 ? 11 : next_ >= 511 ? 10 : 9;
    while (bits_ < width) {
      if (from_ >= packed_.size()) return kEnd;
      held_ = held_ << 8U | static_cast<unsigned char>(packed_[from_++]);
      bits_ += 8;
    }
    bits_ -= width;
    return held_ >> static_cast<unsigned>(bits_) & ((1U << static_cast<unsigned>(width)) - 1U);
  }

  bool put(std::uint32_t code) {
    if (code < 256) {
      out_[to_++] = static_cast<std::uint8_t>(code);
      return true;
    }
    if (code < kFirst || code >= next_) return false;
    // Byte by byte: the last byte may be the first of those just written.
    const std::size_t count = std::min<std::size_t>(lengths_[code], out_.size() - to_);
    for (std::size_t i = 0; i < count; ++i, ++to_) out_[to_] = out_[places_[code] + i];
    return true;
  }

  std::string_view packed_;
  std::vector<std::uint8_t>& out_;
  std::size_t from_ = 0;
  std::size_t to_ = 0;
  std::uint32_t held_ = 0;
  int bits_ = 0;
  std::uint32_t next_ = kFirst;
  std::uint32_t places_[kMostCodes] = {};
  std::uint32_t lengths_[kMostCodes] = {};
};

}  // namespace

bool tiff_compression_known(std::uint32_t compression) {
  return compression == kNone || compression == kLzw || compression == kDeflate ||
         compression == kOldDeflate || compression == kPackBits;
}

bool unpack_tiff_block(std::uint32_t compression, std::string_view packed,
                       std::vector<std::uint8_t>& block) {
  switch (compression) {
    case kNone:
      return copy(packed, block);
    case kLzw:
      return Lzw(packed, block).unpack();
    case kPackBits:
      return unpack_bits(packed, block);
    default:
      return inflate_all(packed, block);
  }
}

}  // namespace dxslam
