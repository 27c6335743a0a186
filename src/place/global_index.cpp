// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "place/global_index.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "matching/descriptor_distance.h"

namespace dxslam {
namespace {

float similarity_of(const cv::Mat& rows, int row, const cv::Mat& wanted) {
  const float distance = descriptor_distance(rows, row, wanted, 0);
  return 1.0F - 0.5F * distance * distance;
}

}  // namespace

double GlobalMatch::distance() const {
  return std::sqrt(std::max(0.0, 2.0 - 2.0 * static_cast<double>(similarity)));
}

void GlobalIndex::add(std::uint32_t id, const std::vector<float>& descriptor) {
  require(!descriptor.empty(), "a global descriptor to index must not be empty");
  if (dimension_ == 0) dimension_ = static_cast<int>(descriptor.size());
  require(static_cast<int>(descriptor.size()) == dimension_,
          "global descriptors of one index must be of one dimension");
  const auto [it, fresh] = row_of_.emplace(id, ids_.size());
  if (fresh) {
    ids_.push_back(id);
    rows_.insert(rows_.end(), descriptor.begin(), descriptor.end());
    return;
  }
  std::copy(descriptor.begin(), descriptor.end(),
            rows_.begin() + static_cast<std::ptrdiff_t>(it->second * descriptor.size()));
}

bool GlobalIndex::remove(std::uint32_t id) {
  const auto it = row_of_.find(id);
  if (it == row_of_.end()) return false;
  // The last row fills the gap.
  const std::size_t row = it->second;
  const std::size_t last = ids_.size() - 1;
  const std::size_t width = static_cast<std::size_t>(dimension_);
  if (row != last) {
    std::copy_n(rows_.begin() + static_cast<std::ptrdiff_t>(last * width), width,
                rows_.begin() + static_cast<std::ptrdiff_t>(row * width));
    ids_[row] = ids_[last];
    row_of_[ids_[row]] = row;
  }
  row_of_.erase(it);
  ids_.pop_back();
  rows_.resize(last * width);
  return true;
}

// cv::Mat has no view of constant data; nothing is written through these.
cv::Mat GlobalIndex::matrix() const {
  return {static_cast<int>(ids_.size()), dimension_, CV_32F, const_cast<float*>(rows_.data())};
}

cv::Mat GlobalIndex::as_row(const std::vector<float>& descriptor) const {
  require(static_cast<int>(descriptor.size()) == dimension_,
          "a global descriptor to compare must have the dimension of the index");
  return {1, dimension_, CV_32F, const_cast<float*>(descriptor.data())};
}

std::vector<GlobalMatch> GlobalIndex::query(const std::vector<float>& descriptor, std::size_t k,
                                            const PlaceExclusion& excluded) const {
  std::vector<GlobalMatch> matches;
  if (descriptor.empty() || ids_.empty()) return matches;
  const cv::Mat rows = matrix();
  const cv::Mat wanted = as_row(descriptor);
  matches.reserve(ids_.size());
  for (int row = 0; row < rows.rows; ++row) {
    const std::uint32_t id = ids_[static_cast<std::size_t>(row)];
    if (excluded && excluded(id)) continue;
    matches.push_back({id, similarity_of(rows, row, wanted)});
  }
  k = std::min(k, matches.size());
  std::partial_sort(matches.begin(), matches.begin() + static_cast<std::ptrdiff_t>(k),
                    matches.end(), [](const GlobalMatch& a, const GlobalMatch& b) {
                      return a.similarity != b.similarity ? a.similarity > b.similarity
                                                          : a.id < b.id;
                    });
  matches.resize(k);
  return matches;
}

GlobalMatch GlobalIndex::compare(std::uint32_t id, const std::vector<float>& descriptor) const {
  const auto found = row_of_.find(id);
  require(found != row_of_.end(), "an image to compare with must have a global descriptor");
  return {id, similarity_of(matrix(), static_cast<int>(found->second), as_row(descriptor))};
}

}  // namespace dxslam
