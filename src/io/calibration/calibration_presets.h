// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <string>
#include <vector>

namespace dxslam {

/// A file of calibration/: its name without ".yaml" and its text.
struct CameraPreset {
  std::string name;
  std::string yaml;
};

/// The table that CMake makes from calibration/*.yaml (src/io/CMakeLists.txt), by name.
const std::vector<CameraPreset>& camera_presets();

}  // namespace dxslam
