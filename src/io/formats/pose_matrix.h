// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <string>

#include "core/se3.h"

namespace dxslam {

/// world_from_camera of 16 numbers, row by row. `where` is "FILE:LINE" for messages. Throws
/// InputError unless the rotation is orthonormal within 1 % and the last row is 0 0 0 1.
SE3 pose_from_row_major(const double (&values)[16], const std::string& where);

/// Throws InputError for a position so far away that squares of it say nothing: no unit of length
/// explains it. `where` is file and line.
void require_near(const Eigen::Vector3d& position, const std::string& where);

}  // namespace dxslam
