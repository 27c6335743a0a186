// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "matching/guided_matching.h"

#include <cmath>
#include <limits>

#include "matching/descriptor_distance.h"

namespace dxslam {
namespace {

bool depth_agrees(float expected, float measured, float tolerance) {
  if (expected <= 0.0F || measured <= 0.0F) return true;
  return std::abs(expected - measured) <= tolerance * expected;
}

}  // namespace

std::vector<Match> match_guided(const std::vector<PixelPrediction>& predictions,
                                const cv::Mat& point_descriptors, const Frame& frame,
                                const KeypointGrid& grid, const std::vector<char>& blocked,
                                const GuidedMatchingOptions& options) {
  std::vector<Match> owner(frame.size(), Match{-1, -1, std::numeric_limits<float>::max()});
  for (std::size_t i = 0; i < predictions.size(); ++i) {
    const PixelPrediction& p = predictions[i];
    float best = std::numeric_limits<float>::max();
    float second = best;
    int best_keypoint = -1;
    grid.for_each_within(p.pixel, p.radius, [&](int k) {
      const std::size_t keypoint = static_cast<std::size_t>(k);
      if (!blocked.empty() && blocked[keypoint] != 0) return;
      if (!depth_agrees(p.depth, frame.depths[keypoint], options.depth_tolerance)) return;
      const float d =
          descriptor_distance(point_descriptors, p.descriptor_row, frame.descriptors, k);
      if (d < best) {
        second = best;
        best = d;
        best_keypoint = k;
      } else if (d < second) {
        second = d;
      }
    });
    if (best_keypoint < 0 || best > options.max_distance || best >= options.ratio * second)
      continue;
    Match& current = owner[static_cast<std::size_t>(best_keypoint)];
    if (best < current.distance) current = {static_cast<int>(i), best_keypoint, best};
  }
  std::vector<int> keypoint_of(predictions.size(), -1);
  for (const Match& m : owner) {
    if (m.a >= 0) keypoint_of[static_cast<std::size_t>(m.a)] = m.b;
  }
  std::vector<Match> matches;
  for (std::size_t i = 0; i < predictions.size(); ++i) {
    if (keypoint_of[i] >= 0) matches.push_back(owner[static_cast<std::size_t>(keypoint_of[i])]);
  }
  return matches;
}

}  // namespace dxslam
