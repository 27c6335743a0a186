// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <string>
#include <vector>

namespace dxslam {

/// One sentence where rising stamps, which should be seconds, look like milli-, micro- or
/// nanoseconds: by their size if they count from 1970, else by the typical step from one to the
/// next, if it is longer than a second. Empty where they look like seconds.
std::string stamp_hint(const std::vector<double>& stamps);

}  // namespace dxslam
