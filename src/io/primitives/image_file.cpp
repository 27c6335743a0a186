// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/primitives/image_file.h"

#include <fmt/format.h>
#include <zlib.h>

#include <cstdint>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <string_view>

#include "core/error.h"
#include "io/primitives/text_file.h"

namespace dxslam {
namespace {

constexpr std::string_view kPngSignature("\x89PNG\r\n\x1a\n", 8);
constexpr std::string_view kJpegSignature("\xFF\xD8\xFF", 3);
constexpr std::uint32_t kLargestSide = 16384;         // pixels
constexpr std::uint64_t kLargestArea = 64ULL << 20U;  // pixels

std::uint32_t big_endian(std::string_view bytes, std::size_t at, std::size_t count) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < count; ++i) {
    value = value << 8U | static_cast<unsigned char>(bytes[at + i]);
  }
  return value;
}

[[noreturn]] void refuse(const std::string& path, const std::string& problem) {
  throw InputError(fmt::format("{}: {}", path, problem));
}

void check_size(const std::string& path, std::uint32_t width, std::uint32_t height) {
  const bool fits = width >= 1 && height >= 1 && width <= kLargestSide && height <= kLargestSide &&
                    std::uint64_t{width} * height <= kLargestArea;
  if (fits) return;
  refuse(path, fmt::format("image of {}x{} pixels, expected 1 to {} a side and at most {} in all",
                           width, height, kLargestSide, kLargestArea));
}

// Walks the chunks: length, type, data, checksum. Decoders silently fill up truncated images or
// print to stderr, so the file has to be known to be whole before one sees it.
void check_png(const std::string& path, std::string_view bytes) {
  std::size_t at = kPngSignature.size();
  for (bool first = true;; first = false) {
    if (bytes.size() - at < 12) refuse(path, "truncated PNG, expected an IEND chunk at its end");
    const std::size_t length = big_endian(bytes, at, 4);
    const std::string_view type = bytes.substr(at + 4, 4);
    if (length > bytes.size() - at - 12) {
      refuse(path, fmt::format("truncated PNG, {} bytes are missing at its end",
                               length - (bytes.size() - at - 12)));
    }
    const auto* data = reinterpret_cast<const Bytef*>(bytes.data() + at + 4);
    if (crc32(0, data, static_cast<uInt>(length + 4)) != big_endian(bytes, at + 8 + length, 4)) {
      refuse(path, fmt::format("damaged PNG, wrong checksum of chunk {}", in_quotes(type)));
    }
    if (first && (type != "IHDR" || length != 13)) refuse(path, "damaged PNG, no IHDR chunk first");
    if (first) check_size(path, big_endian(bytes, at + 8, 4), big_endian(bytes, at + 12, 4));
    if (type == "IEND") return;
    at += length + 12;
  }
}

// Size from the frame header; segments are FF, marker, 16-bit length.
void check_jpeg(const std::string& path, std::string_view bytes) {
  std::string_view content = bytes;
  while (!content.empty() && content.back() == '\0') content.remove_suffix(1);
  if (content.substr(content.size() - 2) != "\xFF\xD9") {
    refuse(path, "truncated JPEG, expected the end marker FFD9 at its end");
  }
  std::size_t at = 2;
  while (at + 9 <= bytes.size()) {
    if (bytes[at] != '\xFF') refuse(path, fmt::format("damaged JPEG, no marker at byte {}", at));
    const std::uint32_t marker = big_endian(bytes, at + 1, 1);
    if (marker == 0xFF) {  // fill byte
      ++at;
      continue;
    }
    const bool frame =
        marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
    if (frame) {
      check_size(path, big_endian(bytes, at + 7, 2), big_endian(bytes, at + 5, 2));
      return;
    }
    if (marker == 0xDA || marker == 0xD9) break;
    at += 2 + big_endian(bytes, at + 2, 2);
  }
  refuse(path, "damaged JPEG, no frame header");
}

// OpenCV's log level is one global; it is silenced only while a decoder runs.
class QuietOpenCv {
 public:
  QuietOpenCv() : level_(cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT)) {}
  ~QuietOpenCv() { cv::utils::logging::setLogLevel(level_); }
  QuietOpenCv(const QuietOpenCv&) = delete;
  QuietOpenCv& operator=(const QuietOpenCv&) = delete;

 private:
  cv::utils::logging::LogLevel level_;
};

cv::Mat decode(const std::string& path) {
  std::string bytes = read_file(path, "a PNG or JPEG image");
  const std::string_view view = bytes;
  if (bytes.empty()) refuse(path, "empty file, expected a PNG or JPEG image");
  if (view.substr(0, kPngSignature.size()) == kPngSignature) {
    check_png(path, view);
  } else if (view.substr(0, kJpegSignature.size()) == kJpegSignature) {
    check_jpeg(path, view);
  } else {
    refuse(path, fmt::format("begins with {}, expected a PNG or JPEG image",
                             in_quotes(view.substr(0, 8))));
  }
  cv::Mat image;
  try {
    const QuietOpenCv quiet;
    const cv::Mat buffer(1, static_cast<int>(bytes.size()), CV_8UC1, bytes.data());
    image = cv::imdecode(buffer, cv::IMREAD_UNCHANGED);
  } catch (const cv::Exception&) {
    image.release();
  }
  if (image.empty()) refuse(path, "damaged image, its pixels cannot be decoded");
  return image;
}

}  // namespace

cv::Mat read_color_image(const std::string& path) {
  cv::Mat image = decode(path);
  if (image.type() == CV_8UC4) cv::cvtColor(image, image, cv::COLOR_BGRA2BGR);
  if (image.type() == CV_8UC3 || image.type() == CV_8UC1) return image;
  refuse(path, fmt::format("{}-bit image of {} channels, expected 8-bit colour or grey",
                           8 * image.elemSize1(), image.channels()));
}

cv::Mat read_depth_image(const std::string& path) {
  cv::Mat image = decode(path);
  if (image.type() == CV_16UC1) return image;
  refuse(path, fmt::format("{}-bit image of {} channels, expected 16-bit depth of one channel",
                           8 * image.elemSize1(), image.channels()));
}

}  // namespace dxslam
