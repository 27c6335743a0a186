// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "vocabulary/descriptor_mean.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace dxslam {
namespace {

constexpr std::size_t kBits = 8;

void add_bits(const std::uint8_t* row, std::size_t bytes, float weight, float* sums) {
  for (std::size_t i = 0; i < bytes; ++i) {
    for (std::size_t bit = 0; bit < kBits; ++bit) {
      sums[i * kBits + bit] += static_cast<float>((row[i] >> bit) & 1) * weight;
    }
  }
}

// The nearest descriptor of unit norm; members that cancel out leave zeros.
void write_direction(const float* sums, std::size_t dimension, float* row) {
  double squared = 0.0;
  for (std::size_t i = 0; i < dimension; ++i) squared += double{sums[i]} * sums[i];
  const double scale = squared > 0.0 ? 1.0 / std::sqrt(squared) : 0.0;
  for (std::size_t i = 0; i < dimension; ++i) row[i] = static_cast<float>(sums[i] * scale);
}

void write_majority(const float* sums, std::size_t bytes, float total, std::uint8_t* row) {
  for (std::size_t i = 0; i < bytes; ++i) {
    unsigned byte = 0;
    for (std::size_t bit = 0; bit < kBits; ++bit) {
      if (2.0F * sums[i * kBits + bit] > total) byte |= 1U << bit;
    }
    row[i] = static_cast<std::uint8_t>(byte);
  }
}

}  // namespace

DescriptorMeans::DescriptorMeans(bool binary, int dimension)
    : binary_(binary),
      dimension_(dimension),
      width_(static_cast<std::size_t>(dimension) * (binary ? kBits : 1)) {}

std::size_t DescriptorMeans::open() {
  sums_.resize(sums_.size() + width_, 0.0F);
  total_.push_back(0.0F);
  return total_.size() - 1;
}

void DescriptorMeans::add(std::size_t group, const cv::Mat& descriptors, int row, float weight) {
  float* sums = sums_.data() + group * width_;
  total_[group] += weight;
  if (binary_) {
    add_bits(descriptors.ptr(row), static_cast<std::size_t>(dimension_), weight, sums);
    return;
  }
  const float* values = descriptors.ptr<float>(row);
  for (std::size_t i = 0; i < width_; ++i) sums[i] += values[i] * weight;
}

cv::Mat DescriptorMeans::means() const {
  cv::Mat means(static_cast<int>(size()), dimension_, binary_ ? CV_8U : CV_32F);
  for (std::size_t g = 0; g < size(); ++g) {
    const float* sums = sums_.data() + g * width_;
    const int row = static_cast<int>(g);
    if (binary_) {
      write_majority(sums, static_cast<std::size_t>(dimension_), total_[g], means.ptr(row));
    } else {
      write_direction(sums, width_, means.ptr<float>(row));
    }
  }
  return means;
}

void DescriptorMeans::keep(const std::vector<std::uint32_t>& groups) {
  for (std::size_t i = 0; i < groups.size(); ++i) {
    std::copy_n(sums_.begin() + static_cast<std::ptrdiff_t>(groups[i] * width_), width_,
                sums_.begin() + static_cast<std::ptrdiff_t>(i * width_));
    total_[i] = total_[groups[i]];
  }
  sums_.resize(groups.size() * width_);
  total_.resize(groups.size());
}

void DescriptorMeans::clear() {
  sums_.clear();
  total_.clear();
}

void DescriptorMeans::restore(std::vector<float> sums, std::vector<float> totals) {
  require(sums.size() == totals.size() * width_, "sums and totals must be of the same groups");
  sums_ = std::move(sums);
  total_ = std::move(totals);
}

}  // namespace dxslam
