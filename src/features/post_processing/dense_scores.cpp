// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "features/post_processing/dense_scores.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>

#include "core/error.h"
#include "core/simd.h"

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

constexpr int kLanes = 8;
using Floats = float __attribute__((vector_size(kLanes * sizeof(float))));
using Flags = std::int32_t __attribute__((vector_size(kLanes * sizeof(std::int32_t))));

/// Whether eight columns of a square, the first of them `first` pixels from the centre's, hold a
/// better score than the centre: all rows at once, without branches to guess wrongly.
DXSLAM_INLINE_KERNEL bool columns_beat(const float* centre, std::ptrdiff_t stride, int radius,
                                       int first) {
  const float score = *centre;
  const float* row_start = centre + first;
  const Flags column = Flags{0, 1, 2, 3, 4, 5, 6, 7} + first;
  const Floats none = Floats{} - std::numeric_limits<float>::max();
  Floats row;
  std::memcpy(&row, row_start, sizeof(row));
  Floats earlier = column < 0 ? row : none;  // these win ties
  Floats later = column > 0 ? row : none;
  for (int d = 1; d <= radius; ++d) {
    std::memcpy(&row, row_start - d * stride, sizeof(row));
    earlier = earlier > row ? earlier : row;
    std::memcpy(&row, row_start + d * stride, sizeof(row));
    later = later > row ? later : row;
  }
  const Flags beaten = ((earlier >= score) | (later > score)) & (column <= radius);
  std::uint64_t words[4];
  std::memcpy(words, &beaten, sizeof(words));
  return ((words[0] | words[1]) | (words[2] | words[3])) != 0;
}

/// Largest radius whose square columns_beat() covers in two goes.
constexpr int kLargestRadius = kLanes - 1;

/// Whether the square holds a better score. All its rows must exist, and eight columns from its
/// left edge on.
DXSLAM_INLINE_KERNEL bool square_beats(const float* centre, std::ptrdiff_t stride, int radius) {
  if (columns_beat(centre, stride, radius, -radius)) return true;
  return 2 * radius >= kLanes && columns_beat(centre, stride, radius, radius - (kLanes - 1));
}

/// Position of the next mark from `from` on, or the size.
int next_mark(const std::vector<std::uint8_t>& marks, int from) {
  const std::size_t left = marks.size() - static_cast<std::size_t>(from);
  const void* found = left == 0 ? nullptr : std::memchr(marks.data() + from, 1, left);
  if (found == nullptr) return static_cast<int>(marks.size());
  return static_cast<int>(static_cast<const std::uint8_t*>(found) - marks.data());
}

/// Whether a row of the square holds a better score; `rivals_win_ties` where they come first in
/// `better`.
bool row_beats(const float* row, int begin, int end, float score, bool rivals_win_ties) {
  bool beaten = false;
  if (rivals_win_ties) {
    for (int u = begin; u < end; ++u) beaten |= row[u] >= score;
  } else {
    for (int u = begin; u < end; ++u) beaten |= row[u] > score;
  }
  return beaten;
}

/// Whether the pixel is the best of its square, as far as that lies in the map; ties as in
/// `better`: rows above and pixels on the left win them. Near rows come first, as what beats a
/// pixel is mostly near.
bool is_maximum(const TensorView& scores, int radius, int x, int y) {
  const float score = *scores.at(y, x);
  const int begin = std::max(0, x - radius);
  const int end = std::min(scores.width, x + radius + 1);
  const float* own = scores.at(y, 0);
  if (row_beats(own, begin, x, score, true) || row_beats(own, x + 1, end, score, false)) {
    return false;
  }
  for (int d = 1; d <= radius; ++d) {
    if (y >= d && row_beats(scores.at(y - d, 0), begin, end, score, true)) return false;
    if (y + d < scores.height && row_beats(scores.at(y + d, 0), begin, end, score, false)) {
      return false;
    }
  }
  return true;
}

/// Appends the maxima of a row. `marks` has a byte for each pixel of the area's rows.
DXSLAM_INLINE_KERNEL void find_in_row(const TensorView& scores, float threshold,
                                      const PixelArea& area, int radius, int y,
                                      std::vector<std::uint8_t>& marks,
                                      std::vector<Candidate>& candidates) {
  const float* row = scores.at(y, area.x_begin);
  const int width = static_cast<int>(marks.size());
  mark_peaks(row, scores.row_stride, width, threshold, marks.data());
  const bool rows_exist = y >= radius && y + radius < scores.height;
  for (int i = next_mark(marks, 0); i < width; i = next_mark(marks, i + 1)) {
    const int x = area.x_begin + i;
    const bool at_once = rows_exist && radius <= kLargestRadius && x >= radius &&
                         x + radius < scores.width && x - radius + kLanes <= scores.width;
    const bool best = at_once ? !square_beats(row + i, scores.row_stride, radius)
                              : is_maximum(scores, radius, x, y);
    if (best) candidates.push_back({x, y, row[i]});
  }
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
                 std::vector<Candidate>& candidates) {
  require(scores.column_stride == 1, "a score map must have rows without gaps");
  require(radius > 0, "find_maxima wants a radius above 0");
  require(area.x_begin > 0 && area.y_begin > 0 && area.x_end < scores.width &&
              area.y_end < scores.height,
          "find_maxima wants an area off the rim of the map");
  const auto find = simd_kernel<find_in_row>();
  std::vector<std::uint8_t> marks(static_cast<std::size_t>(std::max(0, area.x_end - area.x_begin)));
  for (int y = area.y_begin; y < area.y_end; ++y) {
    find(scores, threshold, area, radius, y, marks, candidates);
  }
}

}  // namespace dxslam
