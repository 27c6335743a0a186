// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <string>
#include <vector>

#include "core/camera.h"
#include "io/recordings/depth_registration.h"

namespace dxslam {

// Camera files are YAML with one field of Camera a line, read strictly: unknown keys are errors,
// width, height, fx, fy, cx and cy must be there, the rest has the defaults of Camera. The presets
// are the files of calibration/ at the top of the repository, compiled into the program. The forms
// of others are read as well: foreign_calibration.h.

/// What a camera file says: the colour camera, and the depth camera where depth images are not
/// registered to colour (its optional field depth_camera, with fx, fy, cx and cy and where it is).
struct RgbdCalibration {
  Camera camera;
  DepthCamera depth_camera;
};

/// Throws InputError naming file and line. `where` stands for the file in messages.
RgbdCalibration parse_calibration(const std::string& yaml, const std::string& where);
/// Its colour camera.
Camera parse_camera(const std::string& yaml, const std::string& where);

/// `name_or_file` is the name of a preset or the path of a YAML file (one with a '/' or a '.' in
/// it). Throws InputError if it is neither or cannot be used.
RgbdCalibration load_calibration(const std::string& name_or_file);
Camera load_camera(const std::string& name_or_file);

std::vector<std::string> camera_preset_names();
/// The YAML text of a preset, comments included. Throws InputError for an unknown name.
const std::string& camera_preset_text(const std::string& name);

/// YAML text that parse_camera reads back to the same camera; `title` becomes a comment above.
std::string dump_camera(const Camera& camera, const std::string& title);

}  // namespace dxslam
