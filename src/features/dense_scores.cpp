// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "features/dense_scores.h"

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "core/error.h"

namespace dxslam {
namespace {

/// 1 where the value is above the threshold.
void mark_above(const float* row, int width, float threshold, std::uint8_t* marks) {
  for (int x = 0; x < width; ++x) marks[x] = row[x] > threshold ? 1 : 0;
}

/// 1 where the value is above the threshold and no direct neighbour beats it, ties as in `better`.
/// All four neighbours of every pixel must exist.
DXSLAM_INLINE_KERNEL void mark_peaks(const float* row, std::ptrdiff_t stride, int width,
                                     float threshold, std::uint8_t* marks) {
  const float* above = row - stride;
  const float* below = row + stride;
  for (int x = 0; x < width; ++x) {
    const float v = row[x];
    const float earlier = above[x] > row[x - 1] ? above[x] : row[x - 1];
    const float later = below[x] > row[x + 1] ? below[x] : row[x + 1];
    const float floor = earlier > threshold ? earlier : threshold;
    marks[x] =
        static_cast<std::uint8_t>(static_cast<int>(v > floor) & static_cast<int>(v >= later));
  }
}

using MarkPeaks = void (*)(const float*, std::ptrdiff_t, int, float, std::uint8_t*);

void mark_peaks_generic(const float* row, std::ptrdiff_t stride, int width, float threshold,
                        std::uint8_t* marks) {
  mark_peaks(row, stride, width, threshold, marks);
}

#ifdef DXSLAM_HAS_X86_SIMD
DXSLAM_TARGET_AVX2 void mark_peaks_avx2(const float* row, std::ptrdiff_t stride, int width,
                                        float threshold, std::uint8_t* marks) {
  mark_peaks(row, stride, width, threshold, marks);
}
DXSLAM_TARGET_AVX512 void mark_peaks_avx512(const float* row, std::ptrdiff_t stride, int width,
                                            float threshold, std::uint8_t* marks) {
  mark_peaks(row, stride, width, threshold, marks);
}
#endif

MarkPeaks choose_mark_peaks(SimdLevel level) {
#ifdef DXSLAM_HAS_X86_SIMD
  if (level == SimdLevel::kAvx512) return mark_peaks_avx512;
  if (level == SimdLevel::kAvx2) return mark_peaks_avx2;
#endif
  (void)level;
  return mark_peaks_generic;
}

/// Position of the next mark from `from` on, or the size.
int next_mark(const std::vector<std::uint8_t>& marks, int from) {
  const std::size_t left = marks.size() - static_cast<std::size_t>(from);
  const void* found = left == 0 ? nullptr : std::memchr(marks.data() + from, 1, left);
  if (found == nullptr) return static_cast<int>(marks.size());
  return static_cast<int>(static_cast<const std::uint8_t*>(found) - marks.data());
}

/// Whether the pixel is the best of its square, as far as that lies in the map; ties as in
/// `better`: rows above and pixels on the left win them.
bool is_maximum(const TensorView& scores, int radius, int x, int y) {
  const float score = *scores.at(y, x);
  const int x_begin = std::max(0, x - radius);
  const int x_end = std::min(scores.width, x + radius + 1);
  for (int v = std::max(0, y - radius); v < std::min(scores.height, y + radius + 1); ++v) {
    const float* row = scores.at(v, 0);
    bool beaten = false;
    for (int u = x_begin; u < x; ++u) beaten |= v <= y ? row[u] >= score : row[u] > score;
    if (v != y) beaten |= v < y ? row[x] >= score : row[x] > score;
    for (int u = x + 1; u < x_end; ++u) beaten |= v < y ? row[u] >= score : row[u] > score;
    if (beaten) return false;
  }
  return true;
}

}  // namespace

void find_candidates(const TensorView& scores, float threshold,
                     std::vector<Candidate>& candidates) {
  require(scores.column_stride == 1, "a score map must have rows without gaps");
  std::vector<std::uint8_t> marks(static_cast<std::size_t>(scores.width));
  for (int y = 0; y < scores.height; ++y) {
    const float* row = scores.at(y, 0);
    mark_above(row, scores.width, threshold, marks.data());
    for (int x = next_mark(marks, 0); x < scores.width; x = next_mark(marks, x + 1)) {
      candidates.push_back({x, y, row[x]});
    }
  }
}

void find_maxima(const TensorView& scores, float threshold, const PixelArea& area, int radius,
                 std::vector<Candidate>& candidates, SimdLevel level) {
  require(scores.column_stride == 1, "a score map must have rows without gaps");
  require(radius > 0, "find_maxima wants a radius above 0");
  require(area.x_begin > 0 && area.y_begin > 0 && area.x_end < scores.width &&
              area.y_end < scores.height,
          "find_maxima wants an area off the rim of the map");
  const MarkPeaks mark = choose_mark_peaks(level);
  const int width = std::max(0, area.x_end - area.x_begin);
  std::vector<std::uint8_t> marks(static_cast<std::size_t>(width));
  for (int y = area.y_begin; y < area.y_end; ++y) {
    const float* row = scores.at(y, area.x_begin);
    mark(row, scores.row_stride, width, threshold, marks.data());
    for (int i = next_mark(marks, 0); i < width; i = next_mark(marks, i + 1)) {
      const int x = area.x_begin + i;
      if (is_maximum(scores, radius, x, y)) candidates.push_back({x, y, row[i]});
    }
  }
}

}  // namespace dxslam
