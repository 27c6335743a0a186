// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "core/options.h"

#include <fmt/format.h>

namespace dxslam {

void RangeChecker::check(const char* name, double value, Range range, const char* unit) const {
  if (value >= range.min && value <= range.max) return;
  throw InputError(fmt::format("option {}{} is {} {}, expected {} to {}", prefix_, name, value,
                               unit, range.min, range.max));
}

void RangeChecker::at_most(const char* name, double value, const char* bound_name,
                           double bound) const {
  if (value <= bound) return;
  throw InputError(fmt::format("option {0}{1} is {2}, expected at most {0}{3}, which is {4}",
                               prefix_, name, value, bound_name, bound));
}

}  // namespace dxslam
