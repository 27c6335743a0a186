// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "features/post_processing/descriptor_detection.h"

#include <cmath>

namespace dxslam {
namespace {

/// Highest accepted ratio of the two curvatures.
constexpr double kEdgeRatio = 5.0;

int strongest_channel(const TensorView& map, int y, int x) {
  int best = 0;
  for (int c = 1; c < map.channels; ++c) {
    if (map.value(c, y, x) > map.value(best, y, x)) best = c;
  }
  return best;
}

bool is_local_maximum(const TensorView& map, int channel, int y, int x) {
  const float middle = map.value(channel, y, x);
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      if (map.value(channel, y + dy, x + dx) > middle) return false;
    }
  }
  return true;
}

/// Determinant and trace of the second derivatives tell a peak from a ridge.
bool is_edge(const TensorView& map, int channel, int y, int x) {
  const auto v = [&](int dy, int dx) {
    return static_cast<double>(map.value(channel, y + dy, x + dx));
  };
  const double xx = v(0, -1) - 2.0 * v(0, 0) + v(0, 1);
  const double yy = v(-1, 0) - 2.0 * v(0, 0) + v(1, 0);
  const double xy = 0.25 * (v(-1, -1) - v(-1, 1) - v(1, -1) + v(1, 1));
  const double determinant = xx * yy - xy * xy;
  const double trace = xx + yy;
  const double limit = (kEdgeRatio + 1.0) * (kEdgeRatio + 1.0) / kEdgeRatio;
  return !(determinant > 0.0 && trace * trace < limit * determinant);
}

float soft_score(const TensorView& map, int channel, int y, int x) {
  const float middle = map.value(channel, y, x);
  float sum = 0.0F;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      sum += std::exp(map.value(channel, y + dy, x + dx) - middle);
    }
  }
  return 1.0F / sum;
}

}  // namespace

void find_descriptor_maxima(const TensorView& map, int stride, double threshold,
                            std::vector<Candidate>& candidates) {
  for (int y = 1; y + 1 < map.height; ++y) {
    for (int x = 1; x + 1 < map.width; ++x) {
      const int channel = strongest_channel(map, y, x);
      if (!is_local_maximum(map, channel, y, x) || is_edge(map, channel, y, x)) continue;
      const float score = soft_score(map, channel, y, x);
      if (score > threshold) {
        candidates.push_back({x * stride + stride / 2, y * stride + stride / 2, score});
      }
    }
  }
}

}  // namespace dxslam
