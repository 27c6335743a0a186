// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "features/dense_scores.h"

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

/// Whether a direct neighbour beats the value, ties as in `better`; only neighbours inside the
/// area count, as only these are candidates.
bool beaten(const TensorView& scores, const PixelArea& area, int x, int y) {
  const float* p = scores.at(y, x);
  return (x > area.x_begin && p[-1] >= *p) || (x + 1 < area.x_end && p[1] > *p) ||
         (y > area.y_begin && p[-scores.row_stride] >= *p) ||
         (y + 1 < area.y_end && p[scores.row_stride] > *p);
}

}  // namespace

void find_candidates(const TensorView& scores, float threshold, const PixelArea& area,
                     bool maxima_only, std::vector<Candidate>& candidates) {
  require(scores.column_stride == 1, "find_candidates wants rows without gaps");
  require(area.x_begin >= 0 && area.y_begin >= 0 && area.x_end <= scores.width &&
              area.y_end <= scores.height,
          "find_candidates wants an area inside the map");
  const int width = area.x_end - area.x_begin;
  if (width <= 0) return;
  std::vector<std::uint8_t> marks(static_cast<std::size_t>(width));
  for (int y = area.y_begin; y < area.y_end; ++y) {
    mark_above(scores.at(y, area.x_begin), width, threshold, marks.data());
    for (int i = next_mark(marks, 0); i < width; i = next_mark(marks, i + 1)) {
      const int x = area.x_begin + i;
      if (maxima_only && beaten(scores, area, x, y)) continue;
      candidates.push_back({x, y, *scores.at(y, x)});
    }
  }
}

}  // namespace dxslam
