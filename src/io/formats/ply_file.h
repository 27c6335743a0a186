// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "io/primitives/output_file.h"

namespace dxslam {

using Rgb = std::array<std::uint8_t, 3>;

/// Coloured point in the world frame, metres.
struct PlyPoint {
  Eigen::Vector3d position;
  Rgb color{200, 200, 200};
};

/// Colour of a score of 0 (dark blue) to 1 (yellow); lightness rises with the score, so that it
/// also reads in grey. Scores outside are clamped, NaN counts as 0.
Rgb color_of_score(double score);

/// Binary little-endian PLY: the points, then the keyframe centres (red) joined by edges in their
/// order, as MeshLab and CloudCompare show them. Points that are not finite are left out.
/// Written atomically; throws InputError if that fails.
void write_ply(const std::string& path, const std::vector<PlyPoint>& points,
               const std::vector<Eigen::Vector3d>& keyframe_centres);

/// What write_ply() writes; not other PLY files.
FileKind ply_kind();

}  // namespace dxslam
