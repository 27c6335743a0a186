// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "features/post_processing/cell_scores.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "core/error.h"
#include "core/simd.h"

namespace dxslam {
namespace {

constexpr int kLanes = 16;

/// Logits above this, and cells whose exponentials sum to less than the other, are rare enough to
/// be scaled by their highest first.
constexpr float kLargeLogit = 60.0F;
/// Below this the exponential counts as this one's, which is next to nothing.
constexpr float kSmallLogit = -87.0F;
constexpr float kSmallSum = 1e-17F;

constexpr float kLog2OfE = 1.44269504F;
constexpr float kRound = 12582912.0F;  // 1.5 * 2^23: adding it rounds to the nearest integer
/// 2^f for f from -1/2 to 1/2, relative error below 3e-7; the highest power first.
constexpr float kExponential[] = {1.5403530394e-4F,
                                  1.3333558146e-3F,
                                  9.6181291076e-3F,
                                  5.5504108665e-2F,
                                  2.4022650696e-1F,
                                  6.9314718056e-1F,
                                  1.0F};

/// exp(x) from kSmallLogit to kLargeLogit: 2^round(t) times the polynomial in the rest.
DXSLAM_INLINE_KERNEL float exponential(float x) {
  const float t = x * kLog2OfE;
  const float rounded = t + kRound;
  const float whole = rounded - kRound;
  const float f = t - whole;
  float p = kExponential[0];
  for (int i = 1; i < 7; ++i) p = p * f + kExponential[i];
  const std::int32_t bits = (static_cast<std::int32_t>(whole) + 127) << 23;
  float power = 0.0F;
  std::memcpy(&power, &bits, sizeof(power));
  return p * power;
}

/// log(x) for normal x > 0, absolute error below 1e-6: the exponent, and a polynomial in what is
/// left between sqrt(1/2) and sqrt(2).
DXSLAM_INLINE_KERNEL float logarithm(float x) {
  constexpr std::int32_t kRootHalf = 0x3f3504f3;
  std::int32_t bits = 0;
  std::memcpy(&bits, &x, sizeof(bits));
  const std::int32_t exponent = (bits - kRootHalf) >> 23;
  bits -= exponent * (1 << 23);
  float f = 0.0F;
  std::memcpy(&f, &bits, sizeof(f));
  f -= 1.0F;
  float p = 7.0376836292e-2F;
  p = p * f - 1.1514610310e-1F;
  p = p * f + 1.1676998740e-1F;
  p = p * f - 1.2420140846e-1F;
  p = p * f + 1.4249322787e-1F;
  p = p * f - 1.6668057665e-1F;
  p = p * f + 2.0000714765e-1F;
  p = p * f - 2.4999993993e-1F;
  p = p * f + 3.3333331174e-1F;
  const float square = f * f;
  return f + (p * f * square - 0.5F * square) + 0.69314718056F * static_cast<float>(exponent);
}

/// Vectors of the compiler's, which become those of the processor or several of them.
using Floats = float __attribute__((vector_size(kLanes * sizeof(float))));
using Integers = std::int32_t __attribute__((vector_size(kLanes * sizeof(std::int32_t))));

DXSLAM_INLINE_KERNEL void load(const float* from, Floats& to) {
  std::memcpy(&to, from, sizeof(to));
}

/// exponential() of each lane, limited to its range.
DXSLAM_INLINE_KERNEL void exponentials(Floats& x) {
  const Floats high = Floats{} + kLargeLogit;
  const Floats low = Floats{} + kSmallLogit;
  x = x < high ? x : high;
  x = x > low ? x : low;
  const Floats t = x * kLog2OfE;
  const Floats rounded = t + kRound;
  const Floats whole = rounded - kRound;
  const Floats f = t - whole;
  Floats p = Floats{} + kExponential[0];
  for (int i = 1; i < 7; ++i) p = p * f + kExponential[i];
  const Integers power = (__builtin_convertvector(whole, Integers) + 127) << 23;
  Floats scale;
  std::memcpy(&scale, &power, sizeof(scale));
  x = p * scale;
}

/// Sum of the exponentials of 64 pixels; raises `peaks` lane by lane.
DXSLAM_INLINE_KERNEL float sum_of_64(const float* logits, Floats& peaks) {
  Floats sum{};
  for (int c = 0; c < 64; c += kLanes) {
    Floats x;
    load(logits + c, x);
    peaks = peaks > x ? peaks : x;
    exponentials(x);
    sum += x;
  }
  const float a = (sum[0] + sum[1]) + (sum[2] + sum[3]);
  const float b = (sum[4] + sum[5]) + (sum[6] + sum[7]);
  const float c = (sum[8] + sum[9]) + (sum[10] + sum[11]);
  const float d = (sum[12] + sum[13]) + (sum[14] + sum[15]);
  return (a + b) + (c + d);
}

DXSLAM_INLINE_KERNEL float sum_of_exponentials(const float* logits, int pixels, float& peak) {
  float sum = 0.0F;
  for (int c = 0; c < pixels; ++c) {
    peak = std::max(peak, logits[c]);
    sum += exponential(std::clamp(logits[c], kSmallLogit, kLargeLogit));
  }
  return sum;
}

/// Logarithm of the sum of the exponentials of all channels of a cell, whatever their size.
float careful_normalizer(const float* logits, int channels) {
  const float peak = *std::max_element(logits, logits + channels);
  float sum = 0.0F;
  for (int c = 0; c < channels; ++c) sum += std::exp(logits[c] - peak);
  return peak + std::log(sum);
}

/// What is to be subtracted from the logits of each cell of a row.
DXSLAM_INLINE_KERNEL void find_normalizers(const float* logits, int cells, int pixels, float* out) {
  const int channels = pixels + 1;
  float peak = -std::numeric_limits<float>::max();
  Floats peaks = Floats{} + peak;
  for (int i = 0; i < cells; ++i) {
    const float* in = logits + static_cast<std::ptrdiff_t>(i) * channels;
    out[i] = pixels == 64 ? sum_of_64(in, peaks) : sum_of_exponentials(in, pixels, peak);
  }
  float smallest = std::numeric_limits<float>::max();
  for (int i = 0; i < cells; ++i) {
    const float none = logits[static_cast<std::ptrdiff_t>(i) * channels + pixels];
    peak = std::max(peak, none);
    out[i] += exponential(std::clamp(none, kSmallLogit, kLargeLogit));
    smallest = std::min(smallest, out[i]);
  }
  for (int j = 0; j < kLanes; ++j) peak = std::max(peak, peaks[j]);
  const bool usual = peak < kLargeLogit && smallest > kSmallSum;
  for (int i = 0; i < cells; ++i) out[i] = logarithm(out[i]);
  if (usual) return;
  for (int i = 0; i < cells; ++i) {
    out[i] = careful_normalizer(logits + static_cast<std::ptrdiff_t>(i) * channels, channels);
  }
}

/// The pixels of one cell to their places in the map.
DXSLAM_INLINE_KERNEL void subtract_in_cell(const float* logits, float normalizer, int cell,
                                           std::ptrdiff_t stride, float* out) {
  constexpr int kUsual = 8;
  if (cell != kUsual) {
    for (int c = 0; c < cell * cell; ++c) {
      out[c / cell * stride + c % cell] = logits[c] - normalizer;
    }
    return;
  }
  float values[kUsual * kUsual];
  for (int c = 0; c < kUsual * kUsual; ++c) values[c] = logits[c] - normalizer;
  for (int y = 0; y < kUsual; ++y) {
    std::memcpy(out + y * stride, values + y * kUsual, kUsual * sizeof(float));
  }
}

/// One row of cells to `cell` rows of pixels.
DXSLAM_INLINE_KERNEL void spread_row(const float* logits, int cells, int cell, float* normalizers,
                                     float* out) {
  const int pixels = cell * cell;
  const std::ptrdiff_t stride = static_cast<std::ptrdiff_t>(cells) * cell;
  find_normalizers(logits, cells, pixels, normalizers);
  for (int i = 0; i < cells; ++i) {
    subtract_in_cell(logits + static_cast<std::ptrdiff_t>(i) * (pixels + 1), normalizers[i], cell,
                     stride, out + static_cast<std::ptrdiff_t>(i) * cell);
  }
}

/// The usual size as a constant, for which the loops unroll.
DXSLAM_INLINE_KERNEL void spread_any_row(const float* logits, int cells, int cell,
                                         float* normalizers, float* out) {
  if (cell == 8) {
    spread_row(logits, cells, 8, normalizers, out);
  } else {
    spread_row(logits, cells, cell, normalizers, out);
  }
}

}  // namespace

TensorView CellScores::log_probabilities(const TensorView& logits) {
  require(logits.channel_stride == 1 && logits.channels == cell_ * cell_ + 1 &&
              logits.column_stride == logits.channels,
          "CellScores wants cell * cell + 1 channels side by side");
  const int width = logits.width * cell_;
  const int height = logits.height * cell_;
  map_.resize(static_cast<std::size_t>(width) * height);
  normalizers_.resize(static_cast<std::size_t>(logits.width));
  const auto spread = simd_kernel<spread_any_row>();
  for (int row = 0; row < logits.height; ++row) {
    spread(logits.at(row, 0), logits.width, cell_, normalizers_.data(),
           map_.data() + static_cast<std::size_t>(row) * cell_ * width);
  }
  return TensorView::nchw(map_.data(), 1, height, width);
}

}  // namespace dxslam
