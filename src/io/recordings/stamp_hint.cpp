// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/recordings/stamp_hint.h"

#include <fmt/format.h>

#include <algorithm>

namespace dxslam {
namespace {

struct Unit {
  const char* name;
  double per_second;
};

constexpr Unit kUnits[] = {{"milliseconds", 1e3}, {"microseconds", 1e6}, {"nanoseconds", 1e9}};
constexpr double kEarliest = 3e8;     // seconds: 1979; later stamps count from 1970
constexpr double kLatest = 5e9;       // seconds: 2128
constexpr double kLongestStep = 2.0;  // seconds from one frame or pose to the next

double median_step(const std::vector<double>& stamps) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < stamps.size(); ++i) steps.push_back(stamps[i] - stamps[i - 1]);
  if (steps.empty()) return 0.0;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

}  // namespace

std::string stamp_hint(const std::vector<double>& stamps) {
  const double step = median_step(stamps);
  if (!(step > 1.0)) return {};
  for (const Unit& unit : kUnits) {
    const double first = stamps.front() / unit.per_second;
    const bool by_size = first > kEarliest && first < kLatest;
    const bool by_step = stamps.front() < kEarliest && step / unit.per_second < kLongestStep;
    if (!by_size && !by_step) continue;
    return fmt::format(
        "stamps are typically {:.6g} s apart: they look like {}, expected seconds (divide by {:g})",
        step, unit.name, unit.per_second);
  }
  return fmt::format("stamps are typically {:.6g} s apart, expected seconds", step);
}

}  // namespace dxslam
