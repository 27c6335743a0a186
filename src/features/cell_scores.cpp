// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "features/cell_scores.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "core/error.h"

namespace dxslam {
namespace {

constexpr int kLanes = 16;

/// exp(x) for x <= 0, relative error below 3e-7: 2^round(t) times a polynomial in the rest.
DXSLAM_INLINE_KERNEL float exp_of_negative(float x) {
  constexpr float kRound = 12582912.0F;  // 1.5 * 2^23: adding it rounds to the nearest integer
  const float t = std::max(x, -87.0F) * 1.44269504F;
  const float rounded = t + kRound;
  const float whole = rounded - kRound;
  const float f = t - whole;
  float p = 1.5403530394e-4F;
  p = p * f + 1.3333558146e-3F;
  p = p * f + 9.6181291076e-3F;
  p = p * f + 5.5504108665e-2F;
  p = p * f + 2.4022650696e-1F;
  p = p * f + 6.9314718056e-1F;
  p = p * f + 1.0F;
  const std::int32_t bits = (static_cast<std::int32_t>(whole) + 127) << 23;
  float power = 0.0F;
  std::memcpy(&power, &bits, sizeof(power));
  return p * power;
}

/// Sum of the exponentials of all channels, over that of the highest; and the highest.
DXSLAM_INLINE_KERNEL float sum_of_exponentials(const float* logits, int pixels, float& peak) {
  float lane_max[kLanes];
  float lane_sum[kLanes];
  for (int j = 0; j < kLanes; ++j) {
    lane_max[j] = -std::numeric_limits<float>::max();
    lane_sum[j] = 0.0F;
  }
  const int whole = pixels - pixels % kLanes;
  for (int c = 0; c < whole; c += kLanes) {
    for (int j = 0; j < kLanes; ++j) {
      lane_max[j] = lane_max[j] > logits[c + j] ? lane_max[j] : logits[c + j];
    }
  }
  float best = lane_max[0];
  for (int j = 1; j < kLanes; ++j) best = std::max(best, lane_max[j]);
  for (int c = whole; c < pixels; ++c) best = std::max(best, logits[c]);
  peak = std::max(best, logits[pixels]);
  for (int c = 0; c < whole; c += kLanes) {
    for (int j = 0; j < kLanes; ++j) lane_sum[j] += exp_of_negative(logits[c + j] - peak);
  }
  float sum = exp_of_negative(logits[pixels] - peak);
  for (int j = 0; j < kLanes; ++j) sum += lane_sum[j];
  for (int c = whole; c < pixels; ++c) sum += exp_of_negative(logits[c] - peak);
  return sum;
}

/// One row of cells to `cell` rows of pixels.
DXSLAM_INLINE_KERNEL void spread_row(const float* logits, int cells, int cell, float* out) {
  const int pixels = cell * cell;
  const std::ptrdiff_t stride = static_cast<std::ptrdiff_t>(cells) * cell;
  for (int i = 0; i < cells; ++i) {
    const float* in = logits + static_cast<std::ptrdiff_t>(i) * (pixels + 1);
    float peak = 0.0F;
    const float sum = sum_of_exponentials(in, pixels, peak);
    const float normalizer = peak + std::log(sum);
    for (int y = 0; y < cell; ++y) {
      float* row = out + y * stride + static_cast<std::ptrdiff_t>(i) * cell;
      for (int x = 0; x < cell; ++x) row[x] = in[y * cell + x] - normalizer;
    }
  }
}

/// The usual size as a constant, for which the loops unroll.
DXSLAM_INLINE_KERNEL void spread_any_row(const float* logits, int cells, int cell, float* out) {
  if (cell == 8) {
    spread_row(logits, cells, 8, out);
  } else {
    spread_row(logits, cells, cell, out);
  }
}

using SpreadRow = void (*)(const float*, int, int, float*);

void spread_row_generic(const float* logits, int cells, int cell, float* out) {
  spread_any_row(logits, cells, cell, out);
}

#ifdef DXSLAM_HAS_X86_SIMD
DXSLAM_TARGET_AVX2 void spread_row_avx2(const float* logits, int cells, int cell, float* out) {
  spread_any_row(logits, cells, cell, out);
}
DXSLAM_TARGET_AVX512 void spread_row_avx512(const float* logits, int cells, int cell, float* out) {
  spread_any_row(logits, cells, cell, out);
}
#endif

SpreadRow choose_spread_row(SimdLevel level) {
#ifdef DXSLAM_HAS_X86_SIMD
  if (level == SimdLevel::kAvx512) return spread_row_avx512;
  if (level == SimdLevel::kAvx2) return spread_row_avx2;
#endif
  (void)level;
  return spread_row_generic;
}

}  // namespace

TensorView CellScores::log_probabilities(const TensorView& logits, SimdLevel level) {
  require(logits.channel_stride == 1 && logits.channels == cell_ * cell_ + 1 &&
              logits.column_stride == logits.channels,
          "CellScores wants cell * cell + 1 channels side by side");
  const int width = logits.width * cell_;
  const int height = logits.height * cell_;
  map_.resize(static_cast<std::size_t>(width) * height);
  const SpreadRow spread = choose_spread_row(level);
  for (int row = 0; row < logits.height; ++row) {
    spread(logits.at(row, 0), logits.width, cell_,
           map_.data() + static_cast<std::size_t>(row) * cell_ * width);
  }
  return TensorView::nchw(map_.data(), 1, height, width);
}

}  // namespace dxslam
