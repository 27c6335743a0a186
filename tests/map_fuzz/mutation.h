// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <string>

#include "map_files/map_file.h"
#include "nasty.h"

namespace dxslam::fuzz {

/// Changes numbers and relations in a map without regard to what can be: one value, or the same of
/// all keyframes, keypoints or points. Frames keep as many of everything as keypoints.
void spoil_content(MapSnapshot& snapshot, Chance& chance);

/// Changes the bytes of one section, given by its letters: single values, and whole records that
/// are swapped, repeated, left out or cut.
void spoil_bytes(const std::string& id, std::string& bytes, Chance& chance);

/// The file of a map after some of both, with all checksums right.
std::string spoiled_file(MapSnapshot snapshot, Chance& chance);

}  // namespace dxslam::fuzz
