// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "optimization/sparse_blocks.h"

#include <algorithm>

namespace dxslam {

SparseBlocks::SparseBlocks(int width, int size, std::vector<std::pair<int, int>> coupled)
    : width_(width), starts_(static_cast<std::size_t>(size) + 1, 0) {
  for (int i = 0; i < size; ++i) coupled.emplace_back(i, i);
  std::sort(coupled.begin(), coupled.end(), [](const auto& a, const auto& b) {
    return a.second != b.second ? a.second < b.second : a.first < b.first;
  });
  coupled.erase(std::unique(coupled.begin(), coupled.end()), coupled.end());
  for (const auto& [row, column] : coupled) {
    rows_.push_back(row);
    columns_.push_back(column);
    ++starts_[static_cast<std::size_t>(column) + 1];
  }
  for (std::size_t i = 1; i < starts_.size(); ++i) starts_[i] += starts_[i - 1];

  const Eigen::Index scalars = static_cast<Eigen::Index>(size) * width;
  matrix_.resize(scalars, scalars);
  matrix_.resizeNonZeros(static_cast<Eigen::Index>(rows_.size()) * width * width);
  int* outer = matrix_.outerIndexPtr();
  int* inner = matrix_.innerIndexPtr();
  int next = 0;
  for (std::size_t b = 0; b + 1 < starts_.size(); ++b) {
    for (int c = 0; c < width; ++c) {
      *outer++ = next;
      for (int k = starts_[b]; k < starts_[b + 1]; ++k) {
        for (int r = 0; r < width; ++r) inner[next++] = row(k) * width + r;
      }
    }
  }
  *outer = next;
  set_zero();
}

int SparseBlocks::place(int row, int column) const {
  const auto first = rows_.begin() + starts_[static_cast<std::size_t>(column)];
  const auto last = rows_.begin() + starts_[static_cast<std::size_t>(column) + 1];
  return static_cast<int>(std::lower_bound(first, last, row) - rows_.begin());
}

SparseBlocks::Block SparseBlocks::block(int place) {
  const auto column = static_cast<std::size_t>(this->column(place));
  const Eigen::Index first = starts_[column];
  const Eigen::Index height = width_ * (starts_[column + 1] - first);
  double* data = matrix_.valuePtr() + first * width_ * width_ + (place - first) * width_;
  return {data, width_, width_, Eigen::OuterStride<>(height)};
}

bool SparseBlocks::solve(Eigen::VectorXd& x) {
  if (!analysed_) factor_.analyzePattern(matrix_);
  analysed_ = true;
  factor_.factorize(matrix_);
  if (factor_.info() != Eigen::Success) return false;
  x = factor_.solve(x).eval();
  return true;
}

}  // namespace dxslam
