// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstddef>
#include <string>

#include "core/camera.h"
#include "map/map_types.h"
#include "map_files/map_file.h"

namespace dxslam {

// The bounds of everything that a map file holds, the same for saving and for loading: a file can
// be damaged, or made to do harm, with all its checksums right. One function for each kind of
// value; docs/file_formats.md lists the bounds. Relations between the parts are checked by
// Map(MapParts).

inline constexpr std::size_t kLargestMapFile = std::size_t{1} << 40;  ///< bytes
inline constexpr std::size_t kLongestMapText = 4096;                  ///< bytes
inline constexpr std::size_t kMostCameras = 256;
inline constexpr std::size_t kMostFrameKeypoints = 1000000;
inline constexpr std::size_t kLargestThumbnail = std::size_t{1} << 20;  ///< bytes
inline constexpr double kFarthestInMap = 1e6;  ///< metres from the origin of the world
/// Metres between two keyframes of one world; 1 m for rounding.
inline constexpr double kLongestLoopEdge = 2.0 * kFarthestInMap + 1.0;

/// Without control characters, and not too long.
bool is_possible_text(const std::string& text);
bool is_possible(const DescriptorTraits& traits);
bool is_possible_index(std::int64_t index);
bool is_possible_stamp(double stamp);
/// A rigid motion that does not lead too far.
bool is_possible(const SE3& pose, double farthest = kFarthestInMap);
bool is_possible(const MapPoint& point);
/// Pixels, depths, scores and sigmas; pixels may lie somewhat outside of the image.
bool are_possible_keypoints(const Frame& frame, const Camera& camera);
/// `rows` vectors of about unit length or shorter, one behind the other.
bool are_possible_descriptors(const float* values, std::size_t rows, std::size_t dimension);

/// Whether the keyframes that share points are not far more pairs than the points have
/// observations: few bytes could ask for any amount of memory. Observations by keyframes that do
/// not exist are not counted.
bool is_possible_covisibility(const MapParts& parts);

/// Throws InputError, beginning with `where`, for what load_map would refuse by its numbers: an
/// empty map, too. Vectors of a frame must be of one length (ContractError).
void check_numbers(const MapSnapshot& snapshot, const std::string& where);

}  // namespace dxslam
