// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <string>

namespace dxslam {

/// Folder that holds `manifests/` and `models/`: $DXSLAM_DATA where that is set, else what
/// set_data_directory() was given, else the folder `share/dxslam` of the installation that the
/// library (or, linked statically, the program) lies in, wherever that was moved to; else the
/// source folder the library was built from.
std::string data_directory();
/// For programs that carry the folder along in a place of their own. Before other threads begin.
void set_data_directory(const std::string& folder);
/// Whether the user chose it by $DXSLAM_DATA.
bool is_data_directory_chosen();

/// Folder of data that is not shipped (e.g. other projects' networks): $DXSLAM_SHARED, else
/// `../shared` beside data_directory().
std::string shared_directory();

/// Turns ${DXSLAM_SHARED} into that folder; other text stays as it is.
std::string expand_variables(const std::string& path);

/// Folder for things that may be made again: $XDG_CACHE_HOME/dxslam, else ~/.cache/dxslam; empty
/// where neither is known.
std::string cache_directory();

}  // namespace dxslam
