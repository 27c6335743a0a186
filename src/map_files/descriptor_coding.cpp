// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "map_files/descriptor_coding.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace dxslam {
namespace {

constexpr float kLargest = 127.0F;

// Loops over millions of numbers, compiled for wide registers, too; the processor chooses.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define DXSLAM_WIDE __attribute__((target_clones("avx2", "default")))
#else
#define DXSLAM_WIDE
#endif

DXSLAM_WIDE void encode_int8(const float* values, std::size_t n, std::int8_t* coded) {
  float largest = 0.0F;
  for (std::size_t i = 0; i < n; ++i) largest = std::max(largest, std::abs(values[i]));
  const float scale = largest > 0.0F ? kLargest / largest : 0.0F;
  for (std::size_t i = 0; i < n; ++i) {
    const float scaled = values[i] * scale;
    coded[i] = static_cast<std::int8_t>(
        static_cast<std::int32_t>(scaled + (scaled < 0.0F ? -0.5F : 0.5F)));
  }
}

DXSLAM_WIDE void decode_int8(const std::int8_t* coded, std::size_t n, float* values) {
  std::int32_t sum = 0;
  for (std::size_t i = 0; i < n; ++i) sum += static_cast<std::int32_t>(coded[i]) * coded[i];
  const float scale = sum > 0 ? 1.0F / std::sqrt(static_cast<float>(sum)) : 0.0F;
  for (std::size_t i = 0; i < n; ++i) values[i] = static_cast<float>(coded[i]) * scale;
}

}  // namespace

std::size_t coded_size(DescriptorCoding coding, int dimension) {
  const auto n = static_cast<std::size_t>(dimension);
  return coding == DescriptorCoding::kFloat32 ? n * sizeof(float) : n;
}

void encode_descriptor(DescriptorCoding coding, const void* values, int dimension, char* coded) {
  if (coding == DescriptorCoding::kInt8) {
    encode_int8(static_cast<const float*>(values), static_cast<std::size_t>(dimension),
                reinterpret_cast<std::int8_t*>(coded));
  } else {
    std::memcpy(coded, values, coded_size(coding, dimension));
  }
}

void decode_descriptor(DescriptorCoding coding, const char* coded, int dimension, void* values) {
  if (coding == DescriptorCoding::kInt8) {
    decode_int8(reinterpret_cast<const std::int8_t*>(coded), static_cast<std::size_t>(dimension),
                static_cast<float*>(values));
  } else {
    std::memcpy(values, coded, coded_size(coding, dimension));
  }
}

}  // namespace dxslam
