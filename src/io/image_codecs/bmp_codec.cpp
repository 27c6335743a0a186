// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/error.h"
#include "io/image_codecs/byte_order.h"
#include "io/image_codecs/image_codec.h"
#include "io/primitives/limits.h"

// Uncompressed BMP: a file header of 14 bytes, an information header that begins with its own
// length, a palette for 8 bits a pixel or fewer, and rows of a multiple of 4 bytes, mostly from the
// bottom up.

namespace dxslam {
namespace {

constexpr std::size_t kFileHeader = 14;
constexpr std::uint32_t kOldHeader = 12;  // of OS/2: 16-bit sizes, palette of 3 bytes a colour
constexpr std::uint32_t kPlainHeader = 40;
constexpr std::uint32_t kUncompressed = 0;
constexpr std::uint32_t kBitFields = 3;

struct Layout {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  bool top_down = false;
  std::uint32_t bits = 0;  // of a pixel
  std::size_t palette = 0;
  std::size_t colors = 0;
  std::size_t bytes_per_color = 4;
  std::size_t pixels = 0;
  std::size_t bytes_per_row = 0;
};

bool recognises(std::string_view start) {
  return start.size() >= kFileHeader && start.substr(0, 2) == "BM" &&
         start.substr(6, 4) == std::string_view("\0\0\0\0", 4);
}

void check_kind(std::string_view bytes, std::uint32_t header, const Layout& layout) {
  const std::uint32_t compression =
      header == kOldHeader ? kUncompressed : little_endian32(bytes, kFileHeader + 16);
  const bool plain =
      compression == kUncompressed && (layout.bits == 1 || layout.bits == 4 || layout.bits == 8 ||
                                       layout.bits == 24 || layout.bits == 32);
  // The masks of red, green and blue, as cameras and editors write them for 32 bits.
  const bool usual_masks = compression == kBitFields && layout.bits == 32 &&
                           bytes.size() >= kFileHeader + 52 &&
                           little_endian32(bytes, kFileHeader + 40) == 0xFF0000 &&
                           little_endian32(bytes, kFileHeader + 44) == 0xFF00 &&
                           little_endian32(bytes, kFileHeader + 48) == 0xFF;
  if (plain || usual_masks) return;
  throw InputError(
      fmt::format("BMP of {} bits a pixel and compression {}, expected 1, 4, 8, 24 or 32 "
                  "bits without compression",
                  layout.bits, compression));
}

Layout parse(std::string_view bytes) {
  constexpr const char* kCut = "truncated BMP, its header is not whole";
  if (bytes.size() < kFileHeader + kOldHeader) throw InputError(kCut);
  const std::uint32_t header = little_endian32(bytes, kFileHeader);
  const bool old = header == kOldHeader;
  if (!old && (header < kPlainHeader || header > 1024)) {
    throw InputError(fmt::format("damaged BMP, a header of {} bytes", header));
  }
  if (bytes.size() < kFileHeader + header) throw InputError(kCut);
  Layout layout;
  if (old) {
    layout.width = little_endian16(bytes, kFileHeader + 4);
    layout.height = little_endian16(bytes, kFileHeader + 6);
    layout.bits = little_endian16(bytes, kFileHeader + 10);
    layout.bytes_per_color = 3;
  } else {
    layout.width = little_endian32(bytes, kFileHeader + 4);
    layout.height = little_endian32(bytes, kFileHeader + 8);
    layout.bits = little_endian16(bytes, kFileHeader + 14);
    layout.top_down = layout.height > 0x7FFFFFFFU;
    if (layout.top_down) layout.height = 0U - layout.height;
  }
  check_kind(bytes, header, layout);
  layout.palette = kFileHeader + header;
  layout.pixels = little_endian32(bytes, 10);
  if (layout.bits <= 8 && layout.pixels > layout.palette) {
    layout.colors = std::min((layout.pixels - layout.palette) / layout.bytes_per_color,
                             std::size_t{1} << layout.bits);
  }
  layout.bytes_per_row = (std::size_t{layout.width} * layout.bits + 31) / 32 * 4;
  return layout;
}

cv::Size_<std::uint32_t> inspect(std::string_view bytes) {
  const Layout layout = parse(bytes);
  const bool too_large = layout.width > limits::kImageSide || layout.height > limits::kImageSide;
  const std::size_t end = too_large ? 0 : layout.pixels + layout.bytes_per_row * layout.height;
  if (end > bytes.size()) {
    throw InputError(
        fmt::format("truncated BMP, {} bytes are missing at its end", end - bytes.size()));
  }
  return {layout.width, layout.height};
}

// Missing colours are black.
std::array<cv::Vec3b, 256> read_palette(std::string_view bytes, const Layout& layout) {
  std::array<cv::Vec3b, 256> palette{};
  for (std::size_t i = 0; i < layout.colors; ++i) {
    const std::size_t at = layout.palette + i * layout.bytes_per_color;
    for (int c = 0; c < 3; ++c) {
      palette[i][c] = static_cast<std::uint8_t>(byte_at(bytes, at + static_cast<std::size_t>(c)));
    }
  }
  return palette;
}

void unpack_indexed(std::string_view row, const Layout& layout,
                    const std::array<cv::Vec3b, 256>& palette, bool grey, std::uint8_t* to) {
  const std::uint32_t mask = (1U << layout.bits) - 1;
  for (std::size_t x = 0; x < layout.width; ++x) {
    const std::size_t bit = x * layout.bits;
    const std::size_t shift = 8 - layout.bits - bit % 8;
    const cv::Vec3b& color = palette[byte_at(row, bit / 8) >> shift & mask];
    *to++ = color[0];
    if (grey) continue;
    *to++ = color[1];
    *to++ = color[2];
  }
}

void unpack_direct(std::string_view row, const Layout& layout, std::uint8_t* to) {
  const std::size_t step = layout.bits / 8;
  for (std::size_t x = 0; x < layout.width; ++x, to += 3) {
    std::copy_n(reinterpret_cast<const std::uint8_t*>(row.data()) + x * step, 3, to);
  }
}

cv::Mat decode(std::string_view bytes) {
  const Layout layout = parse(bytes);
  const bool indexed = layout.bits <= 8;
  const auto palette = read_palette(bytes, layout);
  const bool grey = indexed && std::all_of(palette.begin(), palette.end(), [](const cv::Vec3b& c) {
                      return c[0] == c[1] && c[1] == c[2];
                    });
  cv::Mat image(static_cast<int>(layout.height), static_cast<int>(layout.width),
                grey ? CV_8UC1 : CV_8UC3);
  for (std::uint32_t y = 0; y < layout.height; ++y) {
    const std::string_view row =
        bytes.substr(layout.pixels + layout.bytes_per_row * y, layout.bytes_per_row);
    std::uint8_t* to = image.ptr(static_cast<int>(layout.top_down ? y : layout.height - 1 - y));
    if (indexed) {
      unpack_indexed(row, layout, palette, grey, to);
    } else {
      unpack_direct(row, layout, to);
    }
  }
  return image;
}

}  // namespace

const ImageCodec kBmpCodec = {recognises, inspect, decode};

}  // namespace dxslam
