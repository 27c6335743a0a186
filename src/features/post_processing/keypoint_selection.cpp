// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "features/post_processing/keypoint_selection.h"

#include <algorithm>
#include <cstddef>

#include "core/error.h"

namespace dxslam {
namespace {

/// A type of its own, which the algorithms inline; a pointer to the function they do not.
struct Better {
  bool operator()(const Candidate& a, const Candidate& b) const { return better(a, b); }
};

/// A grid over the image and how many candidates each cell may take.
struct Quotas {
  int cell;
  int columns;
  int rows;
  std::size_t quota;
};

/// The grid of `cell` pixels, coarser where there are fewer places to give out than cells.
Quotas plan_quotas(int width, int height, std::size_t wanted, int cell) {
  for (;; cell *= 2) {
    const int columns = (width + cell - 1) / cell;
    const int rows = (height + cell - 1) / cell;
    const std::size_t quota = wanted / (static_cast<std::size_t>(columns) * rows);
    if (quota > 0 || columns * rows == 1) return {cell, columns, rows, quota};
  }
}

/// Moves the candidates that the quotas choose to the front; returns how many.
std::size_t take_quotas(const Quotas& plan, std::vector<Candidate>& candidates) {
  const std::size_t cells = static_cast<std::size_t>(plan.columns) * plan.rows;
  std::vector<std::size_t> begin(cells + 1, 0);
  const auto cell_of = [&](const Candidate& c) {
    return static_cast<std::size_t>(c.y / plan.cell) * plan.columns + c.x / plan.cell;
  };
  for (const Candidate& c : candidates) ++begin[cell_of(c) + 1];
  for (std::size_t i = 0; i < cells; ++i) begin[i + 1] += begin[i];
  std::vector<Candidate> by_cell(candidates.size());
  std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
  for (const Candidate& c : candidates) by_cell[next[cell_of(c)]++] = c;

  std::size_t chosen = 0;
  std::size_t left_over = candidates.size();
  for (std::size_t i = 0; i < cells; ++i) {
    const auto first = by_cell.begin() + static_cast<std::ptrdiff_t>(begin[i]);
    const auto last = by_cell.begin() + static_cast<std::ptrdiff_t>(begin[i + 1]);
    const auto middle = first + std::min(static_cast<std::ptrdiff_t>(plan.quota), last - first);
    if (middle != last) std::nth_element(first, middle, last, Better());
    for (auto it = first; it != middle; ++it) candidates[chosen++] = *it;
    for (auto it = middle; it != last; ++it) candidates[--left_over] = *it;
  }
  return chosen;
}

}  // namespace

void select_keypoints(int width, int height, int count, double spread, int cell,
                      std::vector<Candidate>& candidates) {
  require(count >= 0 && spread >= 0.0 && spread <= 1.0 && cell > 0,
          "select_keypoints wants a count, a share of 0 to 1 and a cell size");
  const auto wanted = static_cast<std::size_t>(count);
  if (candidates.size() > wanted) {
    const auto share = static_cast<std::size_t>(spread * count);
    const std::size_t fixed =
        share == 0 ? 0 : take_quotas(plan_quotas(width, height, share, cell), candidates);
    const auto first = candidates.begin() + static_cast<std::ptrdiff_t>(fixed);
    const auto middle = candidates.begin() + count;
    std::nth_element(first, middle, candidates.end(), Better());
    candidates.resize(wanted);
  }
  std::sort(candidates.begin(), candidates.end(), Better());
}

}  // namespace dxslam
