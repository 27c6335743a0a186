// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

namespace dxslam {

/// Means of groups of descriptors that come in one by one, as descriptors again: floats by
/// direction (unit L2 norm), bytes by the majority of each bit.
class DescriptorMeans {
 public:
  DescriptorMeans(bool binary, int dimension);

  /// A new group without members; its number.
  std::size_t open();
  void add(std::size_t group, const cv::Mat& descriptors, int row, float weight = 1.0F);
  std::size_t size() const { return total_.size(); }
  /// Sum of the weights of the members.
  float total(std::size_t group) const { return total_[group]; }
  /// One row per group; zeros for a group without members.
  cv::Mat means() const;
  /// Keeps these groups only, which get the numbers 0, 1, ...; `groups` rises.
  void keep(const std::vector<std::uint32_t>& groups);
  void clear();

  bool binary() const { return binary_; }
  int dimension() const { return dimension_; }

  // For checkpoints: the state as plain numbers.
  const std::vector<float>& sums() const { return sums_; }
  const std::vector<float>& totals() const { return total_; }
  void restore(std::vector<float> sums, std::vector<float> totals);
  /// Sums that one group takes.
  std::size_t width() const { return width_; }

 private:
  bool binary_;
  int dimension_;
  std::size_t width_;         // floats, or bits where binary
  std::vector<float> sums_;   // width_ a group
  std::vector<float> total_;  // one per group
};

}  // namespace dxslam
