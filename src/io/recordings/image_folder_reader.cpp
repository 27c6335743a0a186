// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "core/error.h"
#include "io/primitives/image_file.h"
#include "io/recordings/sequence_formats.h"

namespace dxslam {
namespace {

constexpr double kFramesASecond = 10.0;

bool all_digits(const std::string& text) {
  return !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
}

// Numbers by value (without leading zeros the longer one is larger), other names by their letters.
bool name_less(const std::filesystem::path& a, const std::filesystem::path& b) {
  const std::string x = a.stem().string();
  const std::string y = b.stem().string();
  if (!all_digits(x) || !all_digits(y)) return a.filename() < b.filename();
  const std::string significant_x = x.substr(std::min(x.find_first_not_of('0'), x.size()));
  const std::string significant_y = y.substr(std::min(y.find_first_not_of('0'), y.size()));
  if (significant_x.size() != significant_y.size()) {
    return significant_x.size() < significant_y.size();
  }
  return significant_x < significant_y;
}

}  // namespace

bool has_images(const std::string& folder) {
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    if (has_image_ending(entry.path())) return true;
  }
  return false;
}

std::vector<std::filesystem::path> list_images(const std::string& folder) {
  std::vector<std::filesystem::path> images;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (has_image_ending(entry.path())) images.push_back(entry.path());
  }
  // Numbers first: comparing numbers with other names by letters would be no order.
  const auto other = std::partition(images.begin(), images.end(), [](const auto& path) {
    return all_digits(path.stem().string());
  });
  std::sort(images.begin(), other, name_less);
  std::sort(other, images.end(), name_less);
  if (images.empty()) {
    throw InputError(
        fmt::format("{}: no image in it, expected PNG, JPEG, BMP, PGM, PPM or TIFF files", folder));
  }
  return images;
}

cv::Size image_size(const std::vector<std::filesystem::path>& images) {
  std::string first_error;
  for (std::size_t i = 0; i < std::min<std::size_t>(images.size(), 10); ++i) {
    try {
      return read_color_image(images[i].string()).size();
    } catch (const InputError& e) {
      if (first_error.empty()) first_error = e.what();
    }
  }
  throw InputError(first_error);
}

Camera made_up_camera(cv::Size size) {
  Camera camera;
  camera.width = size.width;
  camera.height = size.height;
  camera.fx = camera.fy = size.width;
  camera.cx = 0.5 * (size.width - 1);
  camera.cy = 0.5 * (size.height - 1);
  camera.fps = kFramesASecond;
  return camera;
}

SequenceListing list_image_folder(const std::string& folder, const SequenceOptions& options) {
  SequenceListing listing;
  listing.name = folder_name(folder);
  const std::string sub = in_folder(folder, "Images");
  const auto images = list_images(has_images(folder) || !has_images(sub) ? folder : sub);
  if (!use_explicit_calibration(folder, options, listing)) {
    if (options.needs_calibration) {
      throw InputError(fmt::format(
          "{}: images without calibration, expected calibration.yaml beside them or --calibration",
          folder));
    }
    listing.camera = made_up_camera(image_size(images));
    listing.calibration_source = "the first image";
  }
  const std::size_t step = options.eye == "all" ? 1 : 2;
  for (std::size_t i = options.eye == "right" ? 1 : 0; i < images.size(); i += step) {
    const auto place = static_cast<double>(listing.frames.size());
    listing.frames.push_back({place / listing.camera.fps, images[i].string(), {}});
  }
  if (listing.frames.empty()) {
    throw InputError(fmt::format("{}: one image only, expected left and right in turn", folder));
  }
  return listing;
}

}  // namespace dxslam
