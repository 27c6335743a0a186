// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "apps/image_stream.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <memory>
#include <opencv2/imgproc.hpp>
#include <random>
#include <regex>

#include "apps/console.h"
#include "apps/open_recording.h"
#include "apps/process.h"
#include "apps/stoppable_sequence.h"
#include "core/error.h"
#include "io/primitives/image_file.h"
#include "io/primitives/image_listing.h"
#include "io/recordings/sequence_reader.h"
#include "synthetic/low_light.h"

namespace dxslam::apps {
namespace {

namespace fs = std::filesystem;

struct Part {
  std::string folder;
  std::size_t first = 0;
  std::size_t end = std::numeric_limits<std::size_t>::max();
  std::size_t step = 1;
};

Part parse_part(const std::string& source) {
  static const std::regex kPart("(.+)@([0-9]{1,9})?:([0-9]{1,9})?(?::([1-9][0-9]{0,8}))?");
  std::smatch match;
  if (fs::exists(source) || !std::regex_match(source, match, kPart)) return {source};
  Part part{match[1]};
  if (match[2].matched) part.first = std::stoul(match[2]);
  if (match[3].matched) part.end = std::stoul(match[3]);
  if (match[4].matched) part.step = std::stoul(match[4]);
  return part;
}

// Images that lie directly in a folder; recordings keep theirs in folders below it, but for
// 7-Scenes.
std::vector<std::string> photos_in(const std::string& folder) {
  std::vector<std::string> photos;
  const ImageListing listing = list_image_files(folder);
  for (const fs::path& path : listing.files) {
    const std::string name = path.filename().string();
    const bool of_recording =
        name.find(".color.") != std::string::npos || name.find(".depth.") != std::string::npos;
    if (!of_recording) photos.push_back(path.string());
  }
  if (!photos.empty()) {
    for (const std::string& note : listing.notes) warn("{}: {}", folder, note);
  }
  return photos;
}

}  // namespace

ImageStream::ImageStream(const std::vector<std::string>& sources, std::size_t stride) {
  for (const std::string& source : sources) add_source(source, stride);
}

void ImageStream::add_source(const std::string& source, std::size_t stride) {
  const Part part = parse_part(source);
  const std::vector<std::string> photos = photos_in(part.folder);
  const std::size_t count = photos.empty() ? open_recording(part.folder)->size() : photos.size();
  if (part.first >= std::min(count, part.end)) {
    throw InputError(fmt::format("{}: expected a part that begins before the end of the {}", source,
                                 counted(count, "image")));
  }
  for (std::size_t i = part.first; i < std::min(count, part.end); i += part.step * stride) {
    images_.push_back({folders_.size(), i, photos.empty() ? std::string() : photos[i]});
  }
  folders_.push_back(part.folder);
}

void ImageStream::skip(const std::string& reason) {
  if (skipped_++ == 0) first_skipped_ = reason;
}

cv::Mat ImageStream::read_photo(const std::string& path) {
  try {
    return read_color_image(path);
  } catch (const InputError& error) {
    skip(error.what());
    return {};
  }
}

cv::Mat ImageStream::read_frame(RgbdSequence& sequence, std::size_t index) {
  const std::optional<RgbdImage> frame = sequence.read(index);
  if (frame) return frame->color;
  if (stop_requested()) return {};
  skip(sequence.skipped().back().reason);
  return {};
}

void ImageStream::visit(std::size_t start,
                        const std::function<bool(std::size_t, const Item&)>& visit) {
  std::unique_ptr<RgbdSequence> sequence;
  std::size_t open_source = folders_.size();
  for (std::size_t i = start; i < images_.size() && !stop_requested(); ++i) {
    const Image& image = images_[i];
    Item item;
    item.photo = !image.photo.empty();
    item.first = item.photo || i == 0 || images_[i - 1].source != image.source;
    if (!item.photo && image.source != open_source) {
      sequence = stoppable(open_sequence(folders_[image.source]));
      open_source = image.source;
    }
    item.image = item.photo ? read_photo(image.photo) : read_frame(*sequence, image.index);
    if (!item.image.empty() && !visit(i, item)) return;
  }
}

cv::Mat changed_view(const cv::Mat& photo, unsigned seed) {
  constexpr double kShift = 0.08;  // of a corner, in image sizes
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> shift(-kShift, kShift);
  const auto width = static_cast<float>(photo.cols);
  const auto height = static_cast<float>(photo.rows);
  const std::vector<cv::Point2f> corners{{0, 0}, {width, 0}, {width, height}, {0, height}};
  std::vector<cv::Point2f> moved;
  for (const cv::Point2f& corner : corners) {
    const float dx = shift(random) * width;
    moved.emplace_back(corner.x + dx, corner.y + shift(random) * height);
  }
  cv::Mat view;
  cv::warpPerspective(photo, view, cv::getPerspectiveTransform(corners, moved), photo.size(),
                      cv::INTER_LINEAR, cv::BORDER_REFLECT_101);
  if (seed % 2 == 0) return view;
  return LowLight(LowLight::kDefaultGain).apply(view, seed);
}

}  // namespace dxslam::apps
