// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/camera.h"

namespace dxslam {

// Calibrations in the forms of others: settings of ORB-SLAM2 and ORB-SLAM3 (Camera.fx ...),
// camera_info of ROS 1 and ROS 2 (as the calibrator writes it, or a message as text), and the
// camchain of Kalibr, of one camera. Only what describes the camera is taken.

/// The camera, if `yaml` is in one of these forms; not prepared yet. Throws InputError, naming
/// `where`, if it is, but lacks a value or has a model that is not known.
std::optional<Camera> parse_foreign_calibration(const std::string& yaml, const std::string& where);

/// The lens that ROS calls `distortion_model`, with its coefficients in the order of ROS. Throws
/// InputError for a model that is not known, or another number of coefficients.
Lens lens_from_ros(const std::string& distortion_model, const std::vector<double>& coefficients,
                   const std::string& where);

/// What ROS calls a lens model; ours where it knows none.
std::string ros_lens_name(const LensModel& model);

}  // namespace dxslam
