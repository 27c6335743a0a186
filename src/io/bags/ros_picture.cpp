// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/bags/ros_picture.h"

#include <fmt/format.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/error.h"
#include "io/bags/byte_reader.h"
#include "io/primitives/limits.h"
#include "io/primitives/text_file.h"

namespace dxslam {
namespace {

constexpr int kNoConversion = -1;

struct Encoding {
  const char* name;
  int type;     // of the bytes as they are
  int convert;  // cv::ColorConversionCodes, or none
};

// "bayer_rggb8" names the pattern by the first two rows; OpenCV by the second row's middle pixels.
constexpr Encoding kColors[] = {
    {"rgb8", CV_8UC3, cv::COLOR_RGB2BGR},
    {"bgr8", CV_8UC3, kNoConversion},
    {"rgba8", CV_8UC4, cv::COLOR_RGBA2BGR},
    {"bgra8", CV_8UC4, cv::COLOR_BGRA2BGR},
    {"mono8", CV_8UC1, kNoConversion},
    {"8UC1", CV_8UC1, kNoConversion},
    {"8UC3", CV_8UC3, kNoConversion},
    {"8UC4", CV_8UC4, cv::COLOR_BGRA2BGR},
    {"rgb16", CV_16UC3, cv::COLOR_RGB2BGR},
    {"bgr16", CV_16UC3, kNoConversion},
    {"rgba16", CV_16UC4, cv::COLOR_RGBA2BGR},
    {"bgra16", CV_16UC4, cv::COLOR_BGRA2BGR},
    {"yuv422", CV_8UC2, cv::COLOR_YUV2BGR_UYVY},
    {"uyvy", CV_8UC2, cv::COLOR_YUV2BGR_UYVY},
    {"yuv422_yuy2", CV_8UC2, cv::COLOR_YUV2BGR_YUY2},
    {"yuyv", CV_8UC2, cv::COLOR_YUV2BGR_YUY2},
    {"bayer_rggb8", CV_8UC1, cv::COLOR_BayerBG2BGR},
    {"bayer_bggr8", CV_8UC1, cv::COLOR_BayerRG2BGR},
    {"bayer_gbrg8", CV_8UC1, cv::COLOR_BayerGR2BGR},
    {"bayer_grbg8", CV_8UC1, cv::COLOR_BayerGB2BGR},
};

void check_size(std::uint32_t width, std::uint32_t height, const std::string& where,
                const std::optional<ExpectedSize>& expected) {
  if (expected && (std::int64_t{width} != expected->size.width ||
                   std::int64_t{height} != expected->size.height)) {
    throw InputError(fmt::format("{}: image of {}x{} pixels, expected {}x{} as {} says", where,
                                 width, height, expected->size.width, expected->size.height,
                                 expected->source));
  }
  if (width >= 1 && height >= 1 && width <= limits::kImageSide && height <= limits::kImageSide &&
      std::uint64_t{width} * height <= limits::kImageArea) {
    return;
  }
  throw InputError(
      fmt::format("{}: image of {}x{} pixels, expected 1 to {} a side and at most {} in all", where,
                  width, height, limits::kImageSide, limits::kImageArea));
}

// The bytes of the message as an image that owns them, in this machine's order of bytes.
cv::Mat pixels_of(const RosImage& image, int type, const std::string& where,
                  const std::optional<ExpectedSize>& expected) {
  check_size(image.width, image.height, where, expected);
  const auto bytes_per_row = std::uint64_t{image.width} * CV_ELEM_SIZE(type);
  if (image.step < bytes_per_row || image.data.size() < std::uint64_t{image.step} * image.height) {
    throw InputError(fmt::format("{}: {} bytes of {}x{} pixels {}, expected {} per row", where,
                                 image.data.size(), image.width, image.height, image.encoding,
                                 bytes_per_row));
  }
  const cv::Mat view(static_cast<int>(image.height), static_cast<int>(image.width), type,
                     const_cast<char*>(image.data.data()), image.step);
  cv::Mat pixels = view.clone();
  const std::size_t width = CV_ELEM_SIZE1(type);
  if (!image.big_endian || width == 1) return pixels;
  for (std::size_t at = 0; at < pixels.total() * pixels.elemSize(); at += width) {
    std::reverse(pixels.data + at, pixels.data + at + width);
  }
  return pixels;
}

}  // namespace

cv::Mat color_of(const RosImage& image, const std::string& where,
                 const std::optional<ExpectedSize>& expected) {
  for (const Encoding& encoding : kColors) {
    if (image.encoding != encoding.name) continue;
    cv::Mat pixels = pixels_of(image, encoding.type, where, expected);
    if (pixels.depth() == CV_16U) pixels.convertTo(pixels, CV_8U, 1.0 / 257.0);
    if (encoding.convert != kNoConversion) cv::cvtColor(pixels, pixels, encoding.convert);
    return pixels;
  }
  throw InputError(fmt::format("{}: colour image encoded as {}, which is not known", where,
                               in_quotes(image.encoding)));
}

cv::Mat depth_of(const RosImage& image, const std::string& where,
                 const std::optional<ExpectedSize>& expected) {
  if (image.encoding == "16UC1" || image.encoding == "mono16") {
    return pixels_of(image, CV_16UC1, where, expected);
  }
  if (image.encoding != "32FC1") {
    throw InputError(fmt::format("{}: depth image encoded as {}, expected 16UC1 or 32FC1", where,
                                 in_quotes(image.encoding)));
  }
  cv::Mat metres = pixels_of(image, CV_32FC1, where, expected);
  for (int row = 0; row < metres.rows; ++row) {
    for (float* p = metres.ptr<float>(row); p != metres.ptr<float>(row) + metres.cols; ++p) {
      if (!std::isfinite(*p) || *p < 0.0F) *p = 0.0F;
    }
  }
  return metres;
}

CompressedDepth read_compressed_depth(const RosCompressedImage& image, const std::string& where) {
  constexpr std::string_view kPng("\x89PNG", 4);
  CompressedDepth depth;
  depth.rvl = image.format.find("rvl") != std::string::npos;
  depth.data = image.data;
  if (image.data.substr(0, kPng.size()) == kPng) return depth;  // without the usual head
  ByteReader reader(image.data, where);
  reader.number<std::int32_t>();  // always 0
  depth.scale = reader.number<float>();
  depth.shift = reader.number<float>();
  depth.inverse = image.format.find("32FC1") != std::string::npos;
  depth.data = reader.take(reader.left());
  return depth;
}

cv::Mat undo_inverse_depth(const cv::Mat& values, float scale, float shift,
                           const std::string& where) {
  if (values.type() != CV_16UC1) {
    throw InputError(where + ": quantised inverse depth is not of 16 bits, expected such");
  }
  cv::Mat metres(values.size(), CV_32FC1);
  for (int row = 0; row < values.rows; ++row) {
    for (int column = 0; column < values.cols; ++column) {
      const float value = values.at<std::uint16_t>(row, column);
      const float depth = value > 0.0F ? scale / (value - shift) : 0.0F;
      metres.at<float>(row, column) = std::isfinite(depth) && depth > 0.0F ? depth : 0.0F;
    }
  }
  return metres;
}

namespace {

/// Numbers of RVL: groups of three bits behind a bit that says whether more follow, eight groups in
/// a word of 32 bits, the first one in its upper end.
class NibbleReader {
 public:
  NibbleReader(std::string_view data, const std::string& where) : reader_(data, where) {}

  std::uint32_t number() {
    std::uint32_t value = 0;
    for (unsigned shift = 0;; shift += 3) {
      const std::uint32_t nibble = next();
      if (shift < 32) value |= (nibble & 7U) << shift;
      if ((nibble & 8U) == 0 || shift > 32) return value;
    }
  }

 private:
  std::uint32_t next() {
    if (left_ == 0) {
      word_ = reader_.number<std::uint32_t>();
      left_ = 8;
    }
    const std::uint32_t nibble = word_ >> 28U;
    word_ <<= 4U;
    --left_;
    return nibble;
  }

  ByteReader reader_;
  std::uint32_t word_ = 0;
  int left_ = 0;
};

}  // namespace

cv::Mat decode_rvl(std::string_view data, const std::string& where,
                   const std::optional<ExpectedSize>& expected) {
  ByteReader head(data, where);
  const auto columns = head.number<std::uint32_t>();
  const auto rows = head.number<std::uint32_t>();
  check_size(columns, rows, where, expected);
  cv::Mat depth(static_cast<int>(rows), static_cast<int>(columns), CV_16UC1, cv::Scalar(0));
  auto* const pixels = depth.ptr<std::uint16_t>();
  NibbleReader numbers(head.take(head.left()), where);
  std::size_t at = 0;
  std::uint32_t previous = 0;
  while (at < depth.total()) {
    const std::size_t zeros = numbers.number();
    const std::size_t readings = numbers.number();
    if (zeros + readings > depth.total() - at || zeros + readings == 0) {
      throw InputError(where + ": damaged RVL depth image, its runs exceed its size");
    }
    at += zeros;
    for (const std::size_t end = at + readings; at < end; ++at) {
      const std::uint32_t coded = numbers.number();
      previous += (coded >> 1U) ^ (0U - (coded & 1U));  // zigzag: 0, -1, 1, -2, ...
      pixels[at] = static_cast<std::uint16_t>(previous);
    }
  }
  return depth;
}

}  // namespace dxslam
