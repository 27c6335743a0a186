// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "features/dense_scores.h"

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "core/error.h"

namespace dxslam {
namespace {

/// 1 where the value is above the threshold; the loop over a row vectorises.
void mark_above(const float* row, int width, float threshold, std::uint8_t* marks) {
  for (int x = 0; x < width; ++x) marks[x] = row[x] > threshold ? 1 : 0;
}

/// Position of the next mark from `from` on, or the size.
int next_mark(const std::vector<std::uint8_t>& marks, int from) {
  const std::size_t left = marks.size() - static_cast<std::size_t>(from);
  const void* found = left == 0 ? nullptr : std::memchr(marks.data() + from, 1, left);
  if (found == nullptr) return static_cast<int>(marks.size());
  return static_cast<int>(static_cast<const std::uint8_t*>(found) - marks.data());
}

/// Calls visit(x, y) for every pixel of the area above the threshold.
template <class Visit>
void for_each_above(const TensorView& scores, float threshold, const PixelArea& area,
                    const Visit& visit) {
  require(scores.column_stride == 1, "a score map must have rows without gaps");
  require(area.x_begin >= 0 && area.y_begin >= 0 && area.x_end <= scores.width &&
              area.y_end <= scores.height,
          "the area must lie inside the score map");
  const int width = area.x_end - area.x_begin;
  if (width <= 0) return;
  std::vector<std::uint8_t> marks(static_cast<std::size_t>(width));
  for (int y = area.y_begin; y < area.y_end; ++y) {
    mark_above(scores.at(y, area.x_begin), width, threshold, marks.data());
    for (int i = next_mark(marks, 0); i < width; i = next_mark(marks, i + 1)) {
      visit(area.x_begin + i, y);
    }
  }
}

/// Whether a direct neighbour inside the area beats the pixel: true of most that are no maximum.
bool beaten_by_neighbour(const TensorView& scores, const PixelArea& area, int x, int y) {
  const float* p = scores.at(y, x);
  return (x > area.x_begin && p[-1] >= *p) || (x + 1 < area.x_end && p[1] > *p) ||
         (y > area.y_begin && p[-scores.row_stride] >= *p) ||
         (y + 1 < area.y_end && p[scores.row_stride] > *p);
}

/// Whether the pixel is the best of its square, as far as that lies in the area; ties as in
/// `better`: rows above and pixels on the left win them.
bool is_maximum(const TensorView& scores, const PixelArea& area, int radius, int x, int y) {
  if (radius > 0 && beaten_by_neighbour(scores, area, x, y)) return false;
  const float score = *scores.at(y, x);
  const int x_begin = std::max(area.x_begin, x - radius);
  const int x_end = std::min(area.x_end, x + radius + 1);
  for (int v = std::max(area.y_begin, y - radius); v < std::min(area.y_end, y + radius + 1); ++v) {
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

void find_candidates(const TensorView& scores, float threshold, const PixelArea& area,
                     std::vector<Candidate>& candidates) {
  for_each_above(scores, threshold, area,
                 [&](int x, int y) { candidates.push_back({x, y, *scores.at(y, x)}); });
}

void find_maxima(const TensorView& scores, float threshold, const PixelArea& area, int radius,
                 std::vector<Candidate>& candidates) {
  for_each_above(scores, threshold, area, [&](int x, int y) {
    if (is_maximum(scores, area, radius, x, y)) candidates.push_back({x, y, *scores.at(y, x)});
  });
}

}  // namespace dxslam
