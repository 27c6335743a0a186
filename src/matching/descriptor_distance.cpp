// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "matching/descriptor_distance.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

#include "core/error.h"
#include "core/simd.h"
#include "matching/differing_bits.h"

namespace dxslam {
namespace {

constexpr int kRows = 6;  // rows of a block, so that the accumulators stay in registers

// Rows of b transposed into panels of kSimdLanes columns: panel[d * kSimdLanes + lane].
std::vector<float> pack_panels(const cv::Mat& b) {
  const int panels = (b.rows + kSimdLanes - 1) / kSimdLanes;
  std::vector<float> packed(static_cast<std::size_t>(panels) * kSimdLanes * b.cols, 0.0F);
  for (int j = 0; j < b.rows; ++j) {
    float* panel = packed.data() + static_cast<std::size_t>(j / kSimdLanes) * kSimdLanes * b.cols;
    const float* row = b.ptr<float>(j);
    for (int d = 0; d < b.cols; ++d) panel[d * kSimdLanes + j % kSimdLanes] = row[d];
  }
  return packed;
}

DXSLAM_INLINE_KERNEL void dot_block(const float* const* rows, int row_count, const float* panel,
                                    int dim, float* out, int out_stride) {
  FloatLanes sum[kRows] = {};
  for (int d = 0; d < dim; ++d) {
    const FloatLanes column =
        *reinterpret_cast<const FloatLanes*>(panel + static_cast<std::ptrdiff_t>(d) * kSimdLanes);
    for (int r = 0; r < kRows; ++r) sum[r] += rows[r][d] * column;
  }
  for (int r = 0; r < row_count; ++r) {
    std::memcpy(out + static_cast<std::ptrdiff_t>(r) * out_stride, &sum[r], sizeof(FloatLanes));
  }
}

DXSLAM_INLINE_KERNEL void binary_row_similarities(const std::uint8_t* a, const std::uint8_t* b,
                                                  int b_rows, std::size_t b_step, std::size_t bytes,
                                                  float* similarity) {
  for (int j = 0; j < b_rows; ++j) {
    const std::uint8_t* row = b + static_cast<std::size_t>(j) * b_step;
    similarity[j] = static_cast<float>(-count_differing_bits(a, row, bytes));
  }
}

DXSLAM_INLINE_KERNEL float dot(const float* a, const float* b, int dim) {
  FloatLanes sum = {};
  int d = 0;
  for (; d + kSimdLanes <= dim; d += kSimdLanes) {
    sum +=
        *reinterpret_cast<const FloatLanes*>(a + d) * *reinterpret_cast<const FloatLanes*>(b + d);
  }
  float total = 0.0F;
  for (int lane = 0; lane < kSimdLanes; ++lane) total += sum[lane];
  for (; d < dim; ++d) total += a[d] * b[d];
  return total;
}

}  // namespace

float distance_of_similarity(float similarity, bool binary) {
  return binary ? -similarity : std::sqrt(std::max(0.0F, 2.0F - 2.0F * similarity));
}

float descriptor_distance(const cv::Mat& a, int row_a, const cv::Mat& b, int row_b) {
  if (a.depth() == CV_32F) {
    return distance_of_similarity(
        simd_kernel<dot>()(a.ptr<float>(row_a), b.ptr<float>(row_b), a.cols), false);
  }
  return static_cast<float>(simd_kernel<count_differing_bits>()(a.ptr(row_a), b.ptr(row_b),
                                                                static_cast<std::size_t>(a.cols)));
}

DescriptorSimilarities::DescriptorSimilarities(const cv::Mat& a, const cv::Mat& b) : a_(a), b_(b) {
  require(a.empty() || b.empty() || (a.type() == b.type() && a.cols == b.cols),
          "descriptors to compare must be of one type and dimension");
  if (b.depth() == CV_32F) panels_ = pack_panels(b);
}

void DescriptorSimilarities::of_rows(int first, int count, float* similarity) const {
  if (a_.depth() != CV_32F) {
    for (int i = 0; i < count; ++i) {
      simd_kernel<binary_row_similarities>()(a_.ptr(first + i), b_.ptr(), b_.rows, b_.step[0],
                                             static_cast<std::size_t>(a_.cols),
                                             similarity + static_cast<std::size_t>(i) * b_.rows);
    }
    return;
  }
  float block[kRows * kSimdLanes];
  const auto dot_all = simd_kernel<dot_block>();
  for (int i = 0; i < count; i += kRows) {
    const int row_count = std::min(kRows, count - i);
    const float* rows[kRows];
    for (int r = 0; r < kRows; ++r) rows[r] = a_.ptr<float>(first + std::min(i + r, count - 1));
    for (int j = 0; j < b_.rows; j += kSimdLanes) {
      const float* panel = panels_.data() + static_cast<std::size_t>(j) * b_.cols;
      const int columns = std::min(kSimdLanes, b_.rows - j);
      dot_all(rows, row_count, panel, a_.cols, block, kSimdLanes);
      for (int r = 0; r < row_count; ++r) {
        std::copy_n(block + static_cast<std::ptrdiff_t>(r) * kSimdLanes, columns,
                    similarity + static_cast<std::size_t>(i + r) * b_.rows + j);
      }
    }
  }
}

void descriptor_similarities(const cv::Mat& a, const cv::Mat& b, float* similarity) {
  if (a.empty() || b.empty()) return;
  DescriptorSimilarities(a, b).of_rows(0, a.rows, similarity);
}

}  // namespace dxslam
