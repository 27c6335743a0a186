// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <string>

#include "map_files/map_file.h"

namespace dxslam {

/// Both maps in one, the keyframes, points and components of `b` behind those of `a`, each with the
/// world it had: Map::join_components brings two components together once a place of both was
/// recognised. Throws InputError, naming the two by `name_a` and `name_b`, if they were made with
/// different features.
MapSnapshot merge_maps(const StoredMap& a, const std::string& name_a, const StoredMap& b,
                       const std::string& name_b);

}  // namespace dxslam
