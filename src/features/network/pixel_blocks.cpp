// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "features/network/pixel_blocks.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

#include "core/error.h"
#include "core/simd.h"

namespace dxslam {
namespace {

constexpr int kLanes = 16;

struct RowSums {
  std::uint64_t values = 0;
  std::uint64_t squares = 0;
};

/// A row of up to 65536 pixels: no lane overflows 32 bits.
DXSLAM_INLINE_KERNEL RowSums sum_row(const std::uint8_t* row, int width) {
  std::uint32_t values[kLanes] = {};
  std::uint32_t squares[kLanes] = {};
  const int whole = width - width % kLanes;
  for (int x = 0; x < whole; x += kLanes) {
    for (int j = 0; j < kLanes; ++j) {
      const std::uint32_t v = row[x + j];
      values[j] += v;
      squares[j] += v * v;
    }
  }
  RowSums sums;
  for (int j = 0; j < kLanes; ++j) {
    sums.values += values[j];
    sums.squares += squares[j];
  }
  for (int x = whole; x < width; ++x) {
    const std::uint32_t v = row[x];
    sums.values += v;
    sums.squares += v * v;
  }
  return sums;
}

struct Affine {
  float scale;
  float offset;
};

DXSLAM_INLINE_KERNEL void convert(const std::uint8_t* row, int width, Affine map, float* out) {
  for (int x = 0; x < width; ++x) out[x] = static_cast<float>(row[x]) * map.scale + map.offset;
}

DXSLAM_INLINE_KERNEL void convert(const std::uint8_t* row, int width, Affine map,
                                  std::int8_t* out) {
  constexpr float kRound = 12582912.0F;  // 1.5 * 2^23: adding it rounds to the nearest integer
  for (int x = 0; x < width; ++x) {
    float v = static_cast<float>(row[x]) * map.scale + map.offset;
    v = v < -127.0F ? -127.0F : v;
    v = v > 127.0F ? 127.0F : v;
    out[x] = static_cast<std::int8_t>(static_cast<std::int32_t>((v + kRound) - kRound));
  }
}

/// The usual blocks of four have sizes that the compiler knows.
template <class Value>
DXSLAM_INLINE_KERNEL void interleave(const Value* rows, int width, int block, Value* out) {
  const int places = width / block;
  if (block == 4) {
    for (int x = 0; x < places; ++x) {
      for (int r = 0; r < 4; ++r) {
        std::memcpy(out + 16 * x + 4 * r, rows + static_cast<std::ptrdiff_t>(r) * width + 4 * x,
                    4 * sizeof(Value));
      }
    }
    return;
  }
  for (int x = 0; x < places; ++x) {
    for (int r = 0; r < block; ++r) {
      out = std::copy_n(rows + static_cast<std::ptrdiff_t>(r) * width + block * x, block, out);
    }
  }
}

/// One row of places from `block` rows of pixels.
template <class Value>
DXSLAM_INLINE_KERNEL void fill_places(const cv::Mat& grey, int row, int block, Affine map,
                                      Value* buffer, Value* out) {
  for (int r = 0; r < block; ++r) {
    convert(grey.ptr<std::uint8_t>(row * block + r), grey.cols, map,
            buffer + static_cast<std::ptrdiff_t>(r) * grey.cols);
  }
  interleave(buffer, grey.cols, block, out);
}

template <class Value>
void fill(const cv::Mat& grey, int block, Affine map, cv::Mat& out) {
  const auto fill_row = simd_kernel<fill_places<Value>>();
  std::vector<Value> buffer(static_cast<std::size_t>(grey.cols) * block);
  for (int row = 0; row < out.rows; ++row) {
    fill_row(grey, row, block, map, buffer.data(), out.ptr<Value>(row));
  }
}

}  // namespace

PixelStatistics pixel_statistics(const cv::Mat& grey) {
  require(grey.type() == CV_8UC1 && grey.cols <= 65536, "pixel_statistics wants a grey image");
  const auto sum = simd_kernel<sum_row>();
  RowSums total;
  for (int y = 0; y < grey.rows; ++y) {
    const RowSums row = sum(grey.ptr<std::uint8_t>(y), grey.cols);
    total.values += row.values;
    total.squares += row.squares;
  }
  const double count = std::max(1.0, static_cast<double>(grey.total()));
  const double mean = static_cast<double>(total.values) / count;
  const double variance = static_cast<double>(total.squares) / count - mean * mean;
  return {mean, std::sqrt(std::max(0.0, variance))};
}

void pixels_to_blocks(const cv::Mat& grey, int block, float scale, float offset, int type,
                      cv::Mat& out) {
  require(grey.type() == CV_8UC1 && block > 0 && grey.cols % block == 0 && grey.rows % block == 0,
          "pixels_to_blocks wants a grey image of whole blocks");
  require(type == CV_32F || type == CV_8S, "pixels_to_blocks makes CV_32F or CV_8S");
  out.create(grey.rows / block, grey.cols / block, CV_MAKETYPE(type, block * block));
  if (type == CV_32F) {
    fill<float>(grey, block, {scale, offset}, out);
  } else {
    fill<std::int8_t>(grey, block, {scale, offset}, out);
  }
}

}  // namespace dxslam
