// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <utility>
#include <vector>

namespace dxslam {

/// A symmetric matrix of square blocks most of which are zero, and the linear system with it. Only
/// the lower triangle is kept: the blocks of the diagonal (whole) and those of coupled pairs.
/// Internal to this layer.
class SparseBlocks {
 public:
  using Block = Eigen::Map<Eigen::MatrixXd, Eigen::Unaligned, Eigen::OuterStride<>>;

  /// `size` block rows of `width` numbers each. `coupled` holds (row, column) with row > column, in
  /// any order, repetitions allowed.
  SparseBlocks(int width, int size, std::vector<std::pair<int, int>> coupled);

  /// Number of blocks. A place is an index below it.
  int blocks() const { return static_cast<int>(rows_.size()); }
  int row(int place) const { return rows_[static_cast<std::size_t>(place)]; }
  int column(int place) const { return columns_[static_cast<std::size_t>(place)]; }
  /// Where the block of row >= column is; the pair must be coupled or the same.
  int place(int row, int column) const;

  void set_zero() { matrix_.coeffs().setZero(); }
  Block block(int place);

  /// Solves for x, which holds the right side. False if the matrix is not positive definite; x is
  /// then of no use. The order of elimination is found once, at the first call.
  bool solve(Eigen::VectorXd& x);

 private:
  int width_;
  std::vector<int> starts_;   ///< one per column and one more: range of its places
  std::vector<int> rows_;     ///< one per place
  std::vector<int> columns_;  ///< one per place
  Eigen::SparseMatrix<double> matrix_;
  Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> factor_;
  bool analysed_ = false;
};

}  // namespace dxslam
