// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <opencv2/core.hpp>
#include <unordered_map>
#include <vector>

namespace dxslam {

/// Places that must not be found, e.g. those covisible with the query; empty = none.
using PlaceExclusion = std::function<bool(std::uint32_t id)>;

/// A stored image and how much it looks like what was asked for.
struct GlobalMatch {
  std::uint32_t id = 0;
  float similarity = 0.0F;  ///< inner product of the unit vectors, -1 to 1; 1: equal

  /// L2 distance of the two descriptors, 0 to 2: from their inner product, as the paper has it
  /// (III.E).
  double distance() const;
};

/// Global image descriptors by id (paper III.D and III.E): candidates of relocalization and of loop
/// closing. Every query compares with all of them: docs/relocalization.md has the time that takes.
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
  /// Throws ContractError for one of another dimension.
  std::vector<GlobalMatch> query(const std::vector<float>& descriptor, std::size_t k,
                                 const PlaceExclusion& excluded = {}) const;
  /// How alike one image is. Throws ContractError if it is not there or of another dimension.
  GlobalMatch compare(std::uint32_t id, const std::vector<float>& descriptor) const;

 private:
  cv::Mat matrix() const;
  cv::Mat as_row(const std::vector<float>& descriptor) const;

  int dimension_ = 0;
  std::vector<float> rows_;         // row by row
  std::vector<std::uint32_t> ids_;  // one per row
  std::unordered_map<std::uint32_t, std::size_t> row_of_;
};

}  // namespace dxslam
