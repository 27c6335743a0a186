// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/primitives/image_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <new>

#include "core/error.h"
#include "io/image_codecs/image_codec.h"
#include "io/primitives/lfs_pointer.h"
#include "io/primitives/limits.h"
#include "io/primitives/text_file.h"

namespace dxslam {
namespace {

constexpr const ImageCodec* kCodecs[] = {&kPngCodec, &kJpegCodec, &kBmpCodec,
                                         &kPnmCodec, &kTiffCodec, &kExrCodec};
constexpr const char* kExpected = "a PNG, JPEG, BMP, PGM, PPM, TIFF or EXR image";
constexpr int kQuality = 95;
constexpr int kFast = 1;             // zlib's level
constexpr float kFarthest = 1.0e5F;  // metres; renderers write more where there is nothing

[[noreturn]] void refuse(const std::string& path, const std::string& problem) {
  throw InputError(fmt::format("{}: {}", path, problem));
}

const ImageCodec* find_codec(std::string_view start) {
  const auto* const found =
      std::find_if(std::begin(kCodecs), std::end(kCodecs),
                   [&](const ImageCodec* codec) { return codec->recognises(start); });
  return found == std::end(kCodecs) ? nullptr : *found;
}

void check_size(cv::Size_<std::uint32_t> size, const std::optional<ExpectedSize>& expected) {
  if (expected && (std::int64_t{size.width} != expected->size.width ||
                   std::int64_t{size.height} != expected->size.height)) {
    throw InputError(fmt::format("image of {}x{} pixels, expected {}x{} as {} says", size.width,
                                 size.height, expected->size.width, expected->size.height,
                                 expected->source));
  }
  const bool fits = size.width >= 1 && size.height >= 1 && size.width <= limits::kImageSide &&
                    size.height <= limits::kImageSide &&
                    std::uint64_t{size.width} * size.height <= limits::kImageArea;
  if (fits) return;
  throw InputError(
      fmt::format("image of {}x{} pixels, expected 1 to {} a side and at most {} in all",
                  size.width, size.height, limits::kImageSide, limits::kImageArea));
}

cv::Mat decode(std::string_view bytes, const std::string& path,
               const std::optional<ExpectedSize>& expected) {
  if (bytes.empty()) refuse(path, fmt::format("empty file, expected {}", kExpected));
  const std::string_view start = bytes.substr(0, 16);
  const ImageCodec* codec = find_codec(start);
  if (codec == nullptr) {
    refuse(path, fmt::format("begins with {}, expected {}{}", in_quotes(start.substr(0, 8)),
                             kExpected, lfs_hint(bytes)));
  }
  try {
    check_size(codec->inspect(bytes), expected);
    return codec->decode(bytes);
  } catch (const InputError& e) {
    refuse(path, e.what());
  } catch (const cv::Exception&) {  // thrown where memory is short
    refuse(path, "image too large for the memory there is");
  } catch (const std::bad_alloc&) {
    refuse(path, "image too large for the memory there is");
  }
}

std::string ending_of(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

}  // namespace

cv::Mat read_color_image(const std::string& path, const std::optional<ExpectedSize>& expected) {
  return decode_color_image(read_file(path, kExpected, limits::kFileBytes), path, expected);
}

cv::Mat read_depth_image(const std::string& path, const std::optional<ExpectedSize>& expected) {
  return decode_depth_image(read_file(path, kExpected, limits::kFileBytes), path, expected);
}

cv::Mat decode_color_image(std::string_view bytes, const std::string& path,
                           const std::optional<ExpectedSize>& expected) {
  cv::Mat image = decode(bytes, path, expected);
  if (image.type() == CV_8UC3 || image.type() == CV_8UC1) return image;
  if (image.type() == CV_16UC3) {
    cv::Mat narrow;
    image.convertTo(narrow, CV_8U, 1.0 / 257.0);  // 65535 becomes 255
    return narrow;
  }
  refuse(path, fmt::format("{}-bit image of {} channels, expected 8-bit colour or grey, or 16-bit "
                           "colour",
                           8 * image.elemSize1(), image.channels()));
}

cv::Mat decode_depth_image(std::string_view bytes, const std::string& path,
                           const std::optional<ExpectedSize>& expected) {
  cv::Mat image = decode(bytes, path, expected);
  if (image.type() == CV_16UC1) return image;
  if (image.type() == CV_32FC1) {
    for (int y = 0; y < image.rows; ++y) {
      float* row = image.ptr<float>(y);
      std::replace_if(
          row, row + image.cols,
          [](float metres) { return !(metres > 0.0F && metres < kFarthest); }, 0.0F);
    }
    return image;
  }
  refuse(path, fmt::format("{}-bit image of {} channels, expected depth of one channel, 16-bit or "
                           "32-bit float",
                           8 * image.elemSize1(), image.channels()));
}

std::string encode_image(const std::string& path, const cv::Mat& image) {
  const std::string ending = ending_of(path);
  if (ending == ".png") return encode_png(image, kFast);
  if (ending == ".jpg" || ending == ".jpeg") return encode_jpeg(image, kQuality);
  refuse(path, "no kind of image that can be written, expected a name that ends in .png or .jpg");
}

bool has_image_ending(const std::filesystem::path& path) {
  static constexpr std::array<std::string_view, 8> kEndings = {".png", ".jpg", ".jpeg", ".bmp",
                                                               ".pgm", ".ppm", ".tif",  ".tiff"};
  return std::find(kEndings.begin(), kEndings.end(), ending_of(path)) != kEndings.end();
}

bool begins_as_image(std::string_view start) { return find_codec(start) != nullptr; }

}  // namespace dxslam
