// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include <fmt/format.h>

#include "core/error.h"
#include "io/image_codecs/byte_order.h"
#include "io/image_codecs/image_codec.h"
#include "io/primitives/limits.h"

// Binary PGM (P5) and PPM (P6): width, height and largest value as text, one blank, and then the
// pixels, 8 bits or big-endian 16 bits a value.

namespace dxslam {
namespace {

struct Layout {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint32_t largest = 0;
  std::size_t pixels = 0;
  int channels = 1;
};

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

bool recognises(std::string_view start) {
  return start.size() > 2 && (start.substr(0, 2) == "P5" || start.substr(0, 2) == "P6") &&
         is_blank(start[2]);
}

void skip_blanks_and_comments(std::string_view bytes, std::size_t& at) {
  while (at < bytes.size() && (is_blank(bytes[at]) || bytes[at] == '#')) {
    if (bytes[at] == '#') {
      while (at < bytes.size() && bytes[at] != '\n') ++at;
    } else {
      ++at;
    }
  }
}

std::uint32_t parse_number_at(std::string_view bytes, std::size_t& at) {
  skip_blanks_and_comments(bytes, at);
  std::uint32_t value = 0;
  const std::size_t begin = at;
  for (; at < bytes.size() && bytes[at] >= '0' && bytes[at] <= '9' && at - begin < 9; ++at) {
    value = 10 * value + static_cast<std::uint32_t>(bytes[at] - '0');
  }
  if (at == begin || at >= bytes.size()) {
    throw InputError("damaged PNM, expected width, height and largest value in its header");
  }
  return value;
}

Layout parse(std::string_view bytes) {
  Layout layout;
  layout.channels = bytes[1] == '6' ? 3 : 1;
  std::size_t at = 2;
  layout.width = parse_number_at(bytes, at);
  layout.height = parse_number_at(bytes, at);
  layout.largest = parse_number_at(bytes, at);
  // Depth of 16 bits is in raw units, whatever the largest may be.
  const bool raw = layout.channels == 1 && layout.largest > 255 && layout.largest <= 65535;
  if (!is_blank(bytes[at]) || !(raw || layout.largest == 255 || layout.largest == 65535)) {
    throw InputError(
        fmt::format("PNM with {} as largest value, expected 255 or 65535", layout.largest));
  }
  layout.pixels = at + 1;
  return layout;
}

std::size_t bytes_per_row(const Layout& layout) {
  return std::size_t{layout.width} * static_cast<std::size_t>(layout.channels) *
         (layout.largest > 255 ? 2 : 1);
}

cv::Size_<std::uint32_t> inspect(std::string_view bytes) {
  const Layout layout = parse(bytes);
  const std::size_t end = layout.pixels + bytes_per_row(layout) * layout.height;
  const bool too_large = layout.width > limits::kImageSide || layout.height > limits::kImageSide;
  if (!too_large && end > bytes.size()) {
    throw InputError(
        fmt::format("truncated PNM, {} bytes are missing at its end", end - bytes.size()));
  }
  return {layout.width, layout.height};
}

cv::Mat decode(std::string_view bytes) {
  const Layout layout = parse(bytes);
  const bool wide = layout.largest > 255;
  cv::Mat image(static_cast<int>(layout.height), static_cast<int>(layout.width),
                CV_MAKETYPE(wide ? CV_16U : CV_8U, layout.channels));
  const int values = image.cols * layout.channels;
  std::size_t at = layout.pixels;
  for (int y = 0; y < image.rows; ++y) {
    for (int i = 0; i < values; ++i, at += wide ? 2 : 1) {
      const int to = layout.channels == 3 ? i + 2 - 2 * (i % 3) : i;  // RGB to BGR
      if (wide) {
        image.ptr<std::uint16_t>(y)[to] = static_cast<std::uint16_t>(big_endian16(bytes, at));
      } else {
        image.ptr(y)[to] = static_cast<std::uint8_t>(byte_at(bytes, at));
      }
    }
  }
  return image;
}

}  // namespace

const ImageCodec kPnmCodec = {recognises, inspect, decode};

}  // namespace dxslam
