// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "slam/system_options.h"

#include <fmt/format.h>

#include "core/error.h"
#include "core/options.h"

namespace dxslam {

void validate_system_options(const SystemOptions& options) {
  validate_options("", options);
  if (options.mode != "slam" && options.mode != "localization") {
    throw InputError(
        fmt::format("option mode is `{}`, expected slam or localization", options.mode));
  }
  const LoopMethod method = parse_loop_method(options.loop_detection.method);
  if (method.geometry) {
    throw InputError(fmt::format(
        "option loop_detection.method is `{}`, expected a method without +geometry, which is for "
        "`dxslam loops`: SLAM checks the geometry of every loop in its map",
        method.name));
  }
}

}  // namespace dxslam
