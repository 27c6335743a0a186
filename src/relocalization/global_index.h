// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <unordered_map>
#include <vector>

namespace dxslam {

/// Something stored and how much it looks like what was asked for.
struct SimilarKeyframe {
  std::uint32_t id = 0;
  float similarity = 0.0F;  ///< dot product of the unit vectors, -1 to 1; 1: equal
};

/// Global image descriptors by id (paper III.D: candidates of relocalization). Every query compares
/// with all of them, which at 512 floats takes less than a millisecond for ten thousand.
/// One thread may change it; any number may query while none does.
class GlobalIndex {
 public:
  /// Takes a descriptor of unit length. An id that is there already gets the new one. The first
  /// descriptor decides the dimension; throws ContractError for an empty one or another dimension.
  void add(std::uint32_t id, const std::vector<float>& descriptor);
  /// False if there is none of this id.
  bool remove(std::uint32_t id);
  bool contains(std::uint32_t id) const { return row_of_.count(id) != 0; }
  std::size_t size() const { return ids_.size(); }
  /// 0 while nothing was ever added.
  int dimension() const { return dimension_; }

  /// The `k` most similar, best first (ties: smaller id first). None for an empty descriptor.
  std::vector<SimilarKeyframe> query(const std::vector<float>& descriptor, std::size_t k) const;

 private:
  cv::Mat matrix() const;

  int dimension_ = 0;
  std::vector<float> rows_;         // row by row
  std::vector<std::uint32_t> ids_;  // one a row
  std::unordered_map<std::uint32_t, std::size_t> row_of_;
};

}  // namespace dxslam
