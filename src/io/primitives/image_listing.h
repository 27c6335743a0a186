// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace dxslam {

/// Whether the name ends as those of images that read_color_image reads. Hidden files (".x.png",
/// which some systems put beside images) are none.
bool is_image_file(const std::filesystem::path& path);

/// The images that lie directly in a folder, in the order of sort_by_name.
struct ImageListing {
  std::vector<std::filesystem::path> files;
  std::vector<std::string> notes;  ///< choices of the order, and images of kinds that are not read
};

bool has_image_files(const std::string& folder);
/// Empty for a folder that does not exist or cannot be read.
ImageListing list_image_files(const std::string& folder);

}  // namespace dxslam
