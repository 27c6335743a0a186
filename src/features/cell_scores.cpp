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

struct CellStatistics {
  float best;        // of the pixels
  float normalizer;  // log sum exp of all channels
};

DXSLAM_INLINE_KERNEL CellStatistics cell_statistics(const float* logits, int pixels) {
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
  const float peak = std::max(best, logits[pixels]);
  for (int c = 0; c < whole; c += kLanes) {
    for (int j = 0; j < kLanes; ++j) lane_sum[j] += exp_of_negative(logits[c + j] - peak);
  }
  float sum = exp_of_negative(logits[pixels] - peak);
  for (int j = 0; j < kLanes; ++j) sum += lane_sum[j];
  for (int c = whole; c < pixels; ++c) sum += exp_of_negative(logits[c] - peak);
  return {best, sum};
}

DXSLAM_INLINE_KERNEL void normalize_row(const float* logits, int cells, int pixels,
                                        float* normalizers, float* best) {
  for (int i = 0; i < cells; ++i) {
    const float* cell = logits + static_cast<std::ptrdiff_t>(i) * (pixels + 1);
    const CellStatistics statistics = cell_statistics(cell, pixels);
    best[i] = statistics.best;
    normalizers[i] = std::max(statistics.best, cell[pixels]) + std::log(statistics.normalizer);
  }
}

using NormalizeRow = void (*)(const float*, int, int, float*, float*);

void normalize_row_generic(const float* logits, int cells, int pixels, float* n, float* best) {
  normalize_row(logits, cells, pixels, n, best);
}

#ifdef DXSLAM_HAS_X86_SIMD
DXSLAM_TARGET_AVX2 void normalize_row_avx2(const float* logits, int cells, int pixels, float* n,
                                           float* best) {
  normalize_row(logits, cells, pixels, n, best);
}
DXSLAM_TARGET_AVX512 void normalize_row_avx512(const float* logits, int cells, int pixels, float* n,
                                               float* best) {
  normalize_row(logits, cells, pixels, n, best);
}
#endif

NormalizeRow choose_normalize_row(SimdLevel level) {
#ifdef DXSLAM_HAS_X86_SIMD
  if (level == SimdLevel::kAvx512) return normalize_row_avx512;
  if (level == SimdLevel::kAvx2) return normalize_row_avx2;
#endif
  (void)level;
  return normalize_row_generic;
}

}  // namespace

void CellScores::find(const TensorView& logits, double threshold, const PixelArea& area,
                      std::vector<Candidate>& candidates, SimdLevel level) {
  const int pixels = cell_ * cell_;
  require(logits.channel_stride == 1 && logits.channels == pixels + 1 &&
              logits.column_stride == logits.channels,
          "CellScores::find wants cell * cell + 1 channels side by side");
  require(threshold > 0.0, "CellScores::find wants a threshold above 0");
  logits_ = logits;
  const std::size_t cells = static_cast<std::size_t>(logits.height) * logits.width;
  normalizers_.resize(cells);
  best_.resize(cells);
  const NormalizeRow normalize = choose_normalize_row(level);
  const auto log_threshold = static_cast<float>(std::log(threshold));
  for (int row = 0; row < logits.height; ++row) {
    float* normalizers = normalizers_.data() + static_cast<std::size_t>(row) * logits.width;
    float* best = best_.data() + static_cast<std::size_t>(row) * logits.width;
    normalize(logits.at(row, 0), logits.width, pixels, normalizers, best);
    for (int column = 0; column < logits.width; ++column) {
      if (!(best[column] - normalizers[column] > log_threshold)) continue;
      const float* cell = logits.at(row, column);
      for (int c = 0; c < pixels; ++c) {
        const float score = cell[c] - normalizers[column];
        if (!(score > log_threshold)) continue;
        const int x = column * cell_ + c % cell_;
        const int y = row * cell_ + c / cell_;
        if (area.contains(x, y)) candidates.push_back({x, y, score});
      }
    }
  }
}

}  // namespace dxslam
