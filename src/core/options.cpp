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

}  // namespace dxslam
