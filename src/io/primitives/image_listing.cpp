// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/primitives/image_listing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string_view>

#include "io/primitives/image_file.h"
#include "io/primitives/name_order.h"

namespace dxslam {
namespace {

namespace fs = std::filesystem;

// Kinds of images that are not read.
constexpr std::string_view kOthers[] = {".webp", ".heic", ".gif", ".jp2", ".avif", ".dng", ".exr"};

bool is_hidden(const fs::path& path) { return path.filename().string().substr(0, 1) == "."; }

bool is_other_image(const fs::path& path) {
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::find(std::begin(kOthers), std::end(kOthers), ending) != std::end(kOthers) &&
         !is_hidden(path);
}

}  // namespace

bool is_image_file(const fs::path& path) { return has_image_ending(path) && !is_hidden(path); }

bool has_image_files(const std::string& folder) {
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    if (is_image_file(it->path())) return true;
  }
  return false;
}

ImageListing list_image_files(const std::string& folder) {
  ImageListing listing;
  std::size_t others = 0;
  std::string first_other;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    if (is_image_file(it->path())) {
      listing.files.push_back(it->path());
    } else if (is_other_image(it->path()) && others++ == 0) {
      first_other = it->path().filename().string();
    }
  }
  listing.notes = sort_by_name(listing.files);
  if (others > 0 && !listing.files.empty()) {
    listing.notes.push_back(
        fmt::format("{} images of kinds that are not read here were left out, {} among them",
                    others, first_other));
  }
  return listing;
}

}  // namespace dxslam
