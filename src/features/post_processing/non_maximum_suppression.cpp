// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "features/post_processing/non_maximum_suppression.h"

#include <algorithm>
#include <limits>

namespace dxslam {
namespace {

constexpr float kNothing = -std::numeric_limits<float>::max();

}  // namespace

void NonMaximumSuppression::resize(int width, int height, int radius) {
  if (width == width_ && height == height_ && radius == margin_) return;
  width_ = width;
  height_ = height;
  margin_ = radius;
  stride_ = width + 2 * radius;
  map_.assign(static_cast<std::size_t>(stride_) * (height + 2 * radius), kNothing);
}

bool NonMaximumSuppression::is_maximum(const Candidate& candidate, int radius) const {
  const float score = candidate.score;
  const float* centre = pixel(candidate.x, candidate.y);
  if (radius == 0) return true;
  // Most candidates are beaten by a direct neighbour.
  if (centre[-1] >= score || centre[1] > score || centre[-stride_] >= score ||
      centre[stride_] > score) {
    return false;
  }
  for (int dx = 2; dx <= radius; ++dx) {
    if (centre[-dx] >= score || centre[dx] > score) return false;
  }
  for (int dy = 1; dy <= radius; ++dy) {
    const float* above = centre - dy * stride_;
    const float* below = centre + dy * stride_;
    bool beaten = false;
    for (int dx = -radius; dx <= radius; ++dx) {
      beaten = beaten || above[dx] >= score || below[dx] > score;
    }
    if (beaten) return false;
  }
  return true;
}

void NonMaximumSuppression::run(int width, int height, int radius, int iterations,
                                std::vector<Candidate>& candidates) {
  resize(width, height, radius);
  for (const Candidate& c : candidates) *pixel(c.x, c.y) = c.score;
  maxima_.clear();
  rest_.clear();
  for (const Candidate& c : candidates) (is_maximum(c, radius) ? maxima_ : rest_).push_back(c);
  std::size_t done = 0;
  for (int pass = 0; pass < iterations && done < maxima_.size() && !rest_.empty(); ++pass) {
    for (; done < maxima_.size(); ++done) {
      const Candidate& m = maxima_[done];
      for (int dy = -radius; dy <= radius; ++dy) {
        std::fill_n(pixel(m.x - radius, m.y + dy), 2 * radius + 1, kNothing);
      }
    }
    std::size_t left = 0;
    for (const Candidate& c : rest_) {
      if (*pixel(c.x, c.y) == kNothing) continue;
      if (is_maximum(c, radius)) {
        maxima_.push_back(c);
      } else {
        rest_[left++] = c;
      }
    }
    rest_.resize(left);
  }
  for (const Candidate& c : candidates) *pixel(c.x, c.y) = kNothing;
  candidates = maxima_;
}

}  // namespace dxslam
