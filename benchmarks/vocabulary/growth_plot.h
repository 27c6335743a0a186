// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <string>
#include <vector>

namespace dxslam {

/// Query times of a database of one size, in ms of one core's work unless said otherwise.
struct QueryTimes {
  std::size_t keyframes = 0;
  double median_ms = 0.0;
  double p95_ms = 0.0;
  double max_ms = 0.0;
  double median_wall_ms = 0.0;  ///< as passed on the clock
};

/// How they grow in one experiment.
struct Growth {
  std::string label;
  std::vector<QueryTimes> sizes;  ///< by rising number of keyframes
};

/// An SVG picture of the medians (lines) and 95th percentiles (dashed) over the number of
/// keyframes, with a line at `limit_ms`.
std::string draw_growth_svg(const std::vector<Growth>& experiments, double limit_ms,
                            const std::string& title, const std::string& subtitle);

}  // namespace dxslam
