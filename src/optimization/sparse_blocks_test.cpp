// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "optimization/sparse_blocks.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include "core/transform_samples.h"

namespace dxslam {
namespace {

TEST(SparseBlocks, SolvesWhatADenseMatrixSolves) {
  constexpr Eigen::Index kWidth = 3;
  constexpr Eigen::Index kSize = 6;
  SampleSource source(1);
  SparseBlocks blocks(kWidth, kSize, {{5, 0}, {2, 1}, {3, 1}, {5, 4}, {2, 1}, {4, 0}});
  EXPECT_EQ(blocks.blocks(), kSize + 5);
  for (int round = 0; round < 2; ++round) {  // the pattern is found once, the numbers change
    blocks.set_zero();
    Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(kWidth * kSize, kWidth * kSize);
    for (int place = 0; place < blocks.blocks(); ++place) {
      const int row = blocks.row(place);
      const int column = blocks.column(place);
      EXPECT_EQ(blocks.place(row, column), place);
      Eigen::Matrix3d block;
      for (int k = 0; k < 3; ++k) block.col(k) = source.vector(1.0);
      if (row == column) block = (block * block.transpose() + 9.0 * Eigen::Matrix3d::Identity());
      blocks.block(place) += block;
      dense.block<3, 3>(kWidth * row, kWidth * column) = block;
      dense.block<3, 3>(kWidth * column, kWidth * row) = block.transpose();
    }
    Eigen::VectorXd right(kWidth * kSize);
    for (Eigen::Index k = 0; k < kSize; ++k) right.segment<3>(3 * k) = source.vector(1.0);
    Eigen::VectorXd x = right;
    ASSERT_TRUE(blocks.solve(x));
    EXPECT_LT((dense * x - right).norm(), 1e-12);
  }
}

TEST(SparseBlocks, SaysSoIfTheMatrixIsNotPositiveDefinite) {
  SparseBlocks blocks(2, 2, {{1, 0}});
  blocks.block(blocks.place(0, 0)).setIdentity();
  blocks.block(blocks.place(1, 1)).setIdentity();
  blocks.block(blocks.place(1, 0)) = 2.0 * Eigen::Matrix2d::Identity();
  Eigen::VectorXd x = Eigen::VectorXd::Ones(4);
  EXPECT_FALSE(blocks.solve(x));
}

}  // namespace
}  // namespace dxslam
