// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "features/sha256.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

#include "io/primitives/input_file.h"

namespace dxslam {
namespace {

constexpr std::size_t kBlock = 64;

std::uint32_t rotate_right(std::uint32_t x, int n) { return (x >> n) | (x << (32 - n)); }

/// First 32 bits of the fractional part of a root of a prime: the constants of the standard.
std::uint32_t fraction_bits(long double root) {
  return static_cast<std::uint32_t>((root - std::floor(root)) * 4294967296.0L);
}

struct Constants {
  std::array<std::uint32_t, 8> initial{};
  std::array<std::uint32_t, 64> round{};

  Constants() {
    std::size_t count = 0;
    for (int n = 2; count < round.size(); ++n) {
      bool prime = true;
      for (int d = 2; d * d <= n; ++d) prime = prime && n % d != 0;
      if (!prime) continue;
      if (count < initial.size())
        initial[count] = fraction_bits(std::sqrt(static_cast<long double>(n)));
      round[count++] = fraction_bits(std::cbrt(static_cast<long double>(n)));
    }
  }
};

const Constants& constants() {
  static const Constants instance;
  return instance;
}

class Hasher {
 public:
  void update(const std::uint8_t* data, std::size_t size) {
    length_ += size;
    while (size > 0) {
      const std::size_t n = std::min(size, kBlock - used_);
      std::memcpy(buffer_.data() + used_, data, n);
      used_ += n;
      data += n;
      size -= n;
      if (used_ == kBlock) compress();
    }
  }

  std::string finish() {
    const std::uint64_t bits = length_ * 8;
    const std::uint8_t one = 0x80;
    const std::uint8_t zero = 0;
    update(&one, 1);
    while (used_ != kBlock - 8) update(&zero, 1);
    std::array<std::uint8_t, 8> tail{};
    for (std::size_t i = 0; i < 8; ++i) tail[i] = static_cast<std::uint8_t>(bits >> (56 - 8 * i));
    update(tail.data(), tail.size());
    std::string text;
    for (const std::uint32_t word : state_) text += fmt::format("{:08x}", word);
    return text;
  }

 private:
  void compress() {
    std::array<std::uint32_t, 64> w{};
    for (std::size_t i = 0; i < 16; ++i) {
      const std::uint8_t* p = buffer_.data() + 4 * i;
      w[i] = static_cast<std::uint32_t>(p[0]) << 24 | static_cast<std::uint32_t>(p[1]) << 16 |
             static_cast<std::uint32_t>(p[2]) << 8 | p[3];
    }
    for (std::size_t i = 16; i < 64; ++i) {
      const std::uint32_t a = w[i - 15];
      const std::uint32_t b = w[i - 2];
      const std::uint32_t s0 = rotate_right(a, 7) ^ rotate_right(a, 18) ^ (a >> 3);
      const std::uint32_t s1 = rotate_right(b, 17) ^ rotate_right(b, 19) ^ (b >> 10);
      w[i] = w[i - 16] + s0 + w[i - 7] + s1;
    }
    std::array<std::uint32_t, 8> v = state_;
    for (std::size_t i = 0; i < 64; ++i) {
      const std::uint32_t s1 =
          rotate_right(v[4], 6) ^ rotate_right(v[4], 11) ^ rotate_right(v[4], 25);
      const std::uint32_t choice = (v[4] & v[5]) ^ (~v[4] & v[6]);
      const std::uint32_t t1 = v[7] + s1 + choice + constants().round[i] + w[i];
      const std::uint32_t s0 =
          rotate_right(v[0], 2) ^ rotate_right(v[0], 13) ^ rotate_right(v[0], 22);
      const std::uint32_t majority = (v[0] & v[1]) ^ (v[0] & v[2]) ^ (v[1] & v[2]);
      v = {t1 + s0 + majority, v[0], v[1], v[2], v[3] + t1, v[4], v[5], v[6]};
    }
    for (std::size_t i = 0; i < 8; ++i) state_[i] += v[i];
    used_ = 0;
  }

  std::array<std::uint32_t, 8> state_ = constants().initial;
  std::array<std::uint8_t, kBlock> buffer_{};
  std::size_t used_ = 0;
  std::uint64_t length_ = 0;
};

}  // namespace

std::string sha256(const void* data, std::size_t size) {
  Hasher hasher;
  hasher.update(static_cast<const std::uint8_t*>(data), size);
  return hasher.finish();
}

std::string sha256_of_file(const std::string& path) {
  const InputFile file(path, "a model");
  Hasher hasher;
  std::vector<char> chunk(1 << 16);
  for (std::size_t got = chunk.size(); got == chunk.size();) {
    got = file.read(chunk.data(), chunk.size());
    hasher.update(reinterpret_cast<const std::uint8_t*>(chunk.data()), got);
  }
  return hasher.finish();
}

}  // namespace dxslam
