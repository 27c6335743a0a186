// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <string>

#include "map_files/map_file.h"

namespace dxslam {

// Nothing here replaces a file of another kind: InputError.

/// Points coloured by how often they were seen, and the keyframes' centres in the order of their
/// ids, as binary PLY (io/ply_file.h). Components have worlds of their own: with several, take one
/// a file, or all (`component` kNoId) on top of one another. Throws InputError if the file cannot
/// be written.
void write_map_ply(const std::string& path, const Map& map, std::uint32_t component = kNoId);

/// COLMAP's text format: cameras.txt, images.txt and points3D.txt in the subfolders 0, 1, … of
/// `folder`, one for each component, as COLMAP numbers its models. Keypoints are those of the
/// original images, with the lens' distortion (model PINHOLE or FULL_OPENCV) and COLMAP's pixel
/// centres at halves. Images are named by their stamps, as TUM recordings do (`STAMP.png`), with
/// the keyframe's id behind where two would have the same name. Thumbnails, where the map has them,
/// go to the folder `thumbnails` beside these files under the names of their images with `.jpg` in
/// place of `.png`. Throws InputError if the files
/// cannot be written.
void write_map_colmap(const std::string& folder, const StoredMap& stored);

/// The pictures of the keyframes, named by their ids. Returns how many there are; throws InputError
/// where there is none.
std::size_t write_map_thumbnails(const std::string& folder, const StoredMap& stored);

}  // namespace dxslam
