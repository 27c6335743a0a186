// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include <fmt/format.h>

#include <filesystem>

#include "core/error.h"
#include "io/primitives/image_file.h"
#include "io/primitives/image_listing.h"
#include "io/recordings/sequence_formats.h"

namespace dxslam {

std::vector<std::filesystem::path> list_images(const std::string& folder,
                                               SequenceListing& listing) {
  ImageListing images = list_image_files(folder);
  if (images.files.empty()) {
    throw InputError(
        fmt::format("{}: no image in it, expected PNG, JPEG, BMP, PGM, PPM or TIFF files", folder));
  }
  for (std::string& note : images.notes) listing.notes.push_back(std::move(note));
  return std::move(images.files);
}

cv::Size image_size(const std::vector<std::filesystem::path>& images) {
  std::string first_error;
  for (const std::size_t i : probe_order(images.size())) {
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
  camera.fps = kDefaultFps;
  return camera;
}

SequenceListing list_image_folder(const std::string& folder, const SequenceOptions& options) {
  SequenceListing listing;
  listing.name = folder_name(folder);
  const std::string sub = in_folder(folder, "Images");
  const bool below = !has_image_files(folder) && has_image_files(sub);
  const auto images = list_images(below ? sub : folder, listing);
  if (!use_explicit_calibration(folder, options, listing)) {
    if (options.needs_calibration) {
      throw InputError(fmt::format(
          "{}: images without calibration, expected calibration.yaml beside them or --calibration",
          folder));
    }
    listing.camera = made_up_camera(image_size(images));
    listing.calibration_source = "the first image's size alone";
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
