// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>

#include "core/error.h"
#include "io/image_codecs/byte_order.h"
#include "io/image_codecs/image_codec.h"
#include "io/image_codecs/tiff_compression.h"
#include "io/primitives/limits.h"

// The first image of a TIFF 6.0 file, as depth maps and masks have them: 1 or 8 bits, 16 bits, or
// 32-bit float; strips or tiles; no compression, PackBits, LZW or Deflate, with the predictors 2
// and 3. libtiff is not used: Debian's links jbigkit, which is under the GPL.

namespace dxslam {
namespace {

enum Tag : std::uint32_t {
  kWidth = 256,
  kHeight = 257,
  kBits = 258,
  kCompression = 259,
  kPhotometric = 262,
  kFillOrder = 266,
  kStripOffsets = 273,
  kSamples = 277,
  kRowsPerStrip = 278,
  kStripBytes = 279,
  kPlanar = 284,
  kPredictor = 317,
  kColorMap = 320,
  kTileWidth = 322,
  kTileHeight = 323,
  kTileOffsets = 324,
  kTileBytes = 325,
  kSampleFormat = 339,
};

constexpr std::size_t kMostTags = 128;
constexpr std::uint32_t kWhiteIsZero = 0;
constexpr std::uint32_t kRgb = 2;
constexpr std::uint32_t kPalette = 3;
constexpr std::uint32_t kUnsigned = 1;
constexpr std::uint32_t kFloat = 3;

bool recognises(std::string_view start) {
  return start.substr(0, 4) == std::string_view("II*\0", 4) ||
         start.substr(0, 4) == std::string_view("MM\0*", 4);
}

[[noreturn]] void damaged(const char* what) {
  throw InputError(fmt::format("damaged TIFF, {}", what));
}

/// The tags of the first image, with bounds checked.
class Directory {
 public:
  explicit Directory(std::string_view bytes) : bytes_(bytes), big_(bytes[0] == 'M') {
    if (bytes.size() < 8) damaged("its header is not whole");
    const std::size_t at = u32(4);
    if (at > bytes.size() || bytes.size() - at < 2) damaged("no directory where its header says");
    entries_ = at + 2;
    count_ = u16(at);
    if (count_ > kMostTags) damaged("more tags than an image has");
    if (bytes.size() - entries_ < 12 * count_) damaged("its directory is not whole");
  }

  bool big_endian() const { return big_; }
  bool has(Tag tag) const { return entry(tag) != 0; }
  std::size_t count(Tag tag) const { return has(tag) ? u32(entry(tag) + 4) : 0; }

  /// Element `index` of the values, or `missing` if there is no such tag.
  std::uint32_t get(Tag tag, std::uint32_t missing, std::size_t index = 0) const {
    const std::size_t at = entry(tag);
    if (at == 0) return missing;
    const std::uint32_t type = u16(at + 2);
    if (type != 1 && type != 3 && type != 4) damaged("a tag of a type that does not fit");
    const std::size_t bytes_per_value = type == 1 ? 1 : type == 3 ? 2 : 4;
    const std::size_t values = u32(at + 4);
    if (index >= values) damaged("a list in its directory is too short");
    const std::size_t begin = values * bytes_per_value <= 4 ? at + 8 : u32(at + 8);
    const std::size_t place = begin + index * bytes_per_value;
    if (place + bytes_per_value > bytes_.size()) damaged("a list lies behind its end");
    return type == 1 ? byte_at(bytes_, place) : type == 3 ? u16(place) : u32(place);
  }

 private:
  std::uint32_t u16(std::size_t at) const {
    return big_ ? big_endian16(bytes_, at) : little_endian16(bytes_, at);
  }
  std::uint32_t u32(std::size_t at) const {
    return big_ ? big_endian32(bytes_, at) : little_endian32(bytes_, at);
  }
  std::size_t entry(Tag tag) const {  // 0: none
    for (std::size_t i = 0; i < count_; ++i) {
      if (u16(entries_ + 12 * i) == tag) return entries_ + 12 * i;
    }
    return 0;
  }

  std::string_view bytes_;
  bool big_;
  std::size_t entries_ = 0;
  std::size_t count_ = 0;
};

/// What a file's image is made of. A block is a strip or a tile.
struct Layout {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint32_t bits = 1;  // of a sample
  std::uint32_t samples = 1;
  std::uint32_t format = kUnsigned;
  std::uint32_t compression = 1;
  std::uint32_t predictor = 1;
  std::uint32_t photometric = kWhiteIsZero;
  std::uint32_t block_width = 0;
  std::uint32_t block_height = 0;
  bool tiled = false;
  bool big_endian = false;

  std::size_t blocks_across() const { return (width + block_width - 1) / block_width; }
  std::size_t blocks_down() const { return (height + block_height - 1) / block_height; }
  std::size_t bytes_per_row() const { return (std::size_t{block_width} * samples * bits + 7) / 8; }
  Tag offsets() const { return tiled ? kTileOffsets : kStripOffsets; }
  Tag sizes() const { return tiled ? kTileBytes : kStripBytes; }
};

void check_kind(const Layout& layout, const Directory& directory) {
  const bool grey = layout.photometric <= 1 && (layout.samples == 1 || layout.samples == 2);
  const bool color = layout.photometric == kRgb && (layout.samples == 3 || layout.samples == 4);
  const bool palette = layout.photometric == kPalette && layout.samples == 1 && layout.bits == 8;
  const bool integer =
      layout.format == kUnsigned &&
      (layout.bits == 8 || layout.bits == 16 || (layout.bits == 1 && grey && layout.samples == 1));
  const bool real = layout.format == kFloat && layout.bits == 32 && grey;
  if (!((grey || color || palette) && (integer || real))) {
    throw InputError(
        fmt::format("TIFF of {} samples of {} bits (sample format {}, photometric "
                    "{}), expected grey or colour of 8 or 16 bits, black and white "
                    "of 1 bit, or grey of 32-bit float",
                    layout.samples, layout.bits, layout.format, layout.photometric));
  }
  for (std::size_t i = 1; i < std::min<std::size_t>(layout.samples, directory.count(kBits)); ++i) {
    if (directory.get(kBits, 0, i) != layout.bits) damaged("samples of different sizes");
  }
  if (directory.get(kPlanar, 1) != 1 && layout.samples > 1) {
    throw InputError("TIFF with a plane for each colour, expected the colours of a pixel together");
  }
  if (directory.get(kFillOrder, 1) != 1) throw InputError("TIFF with reversed bits");
  if (!tiff_compression_known(layout.compression)) {
    throw InputError(
        fmt::format("TIFF with compression {}, expected none, PackBits, LZW or "
                    "Deflate",
                    layout.compression));
  }
  const bool predictable = layout.predictor == 1 || (layout.predictor == 2 && layout.bits >= 8) ||
                           (layout.predictor == 3 && real);
  if (!predictable) damaged("a predictor that does not fit its samples");
}

Layout parse(const Directory& directory) {
  Layout layout;
  layout.width = directory.get(kWidth, 0);
  layout.height = directory.get(kHeight, 0);
  layout.bits = directory.get(kBits, 1);
  layout.samples = directory.get(kSamples, 1);
  layout.format = directory.get(kSampleFormat, kUnsigned);
  layout.compression = directory.get(kCompression, 1);
  layout.predictor = directory.get(kPredictor, 1);
  layout.photometric = directory.get(kPhotometric, kWhiteIsZero);
  layout.big_endian = directory.big_endian();
  layout.tiled = directory.has(kTileOffsets);
  if (layout.tiled) {
    layout.block_width = directory.get(kTileWidth, 0);
    layout.block_height = directory.get(kTileHeight, 0);
    const auto fits = [](std::uint32_t side) { return side >= 16 && side <= 4096; };
    if (!fits(layout.block_width) || !fits(layout.block_height)) {
      damaged("tiles of fewer than 16 or more than 4096 pixels a side");
    }
  } else {
    layout.block_width = layout.width;
    layout.block_height = std::min(directory.get(kRowsPerStrip, layout.height), layout.height);
  }
  check_kind(layout, directory);
  return layout;
}

cv::Size_<std::uint32_t> inspect(std::string_view bytes) {
  const Directory directory(bytes);
  const Layout layout = parse(directory);
  const cv::Size_<std::uint32_t> size(layout.width, layout.height);
  if (layout.width > limits::kImageSide || layout.height > limits::kImageSide) return size;
  if (layout.width == 0 || layout.height == 0) return size;
  if (layout.block_height == 0) damaged("strips without rows");
  std::uint64_t packed = 0;
  for (std::size_t i = 0; i < layout.blocks_across() * layout.blocks_down(); ++i) {
    const std::uint64_t begin = directory.get(layout.offsets(), 0, i);
    const std::uint64_t count = directory.get(layout.sizes(), 0, i);
    const std::uint64_t end = begin + count;
    packed += count;
    if (packed > bytes.size() && end <= bytes.size()) damaged("strips or tiles overlap");
    if (end > bytes.size()) {
      throw InputError(
          fmt::format("truncated TIFF, {} bytes are missing at its end", end - bytes.size()));
    }
  }
  return size;
}

template <class Sample>
void undo_differences(std::uint8_t* row, const Layout& layout) {
  const std::size_t values = std::size_t{layout.block_width} * layout.samples;
  auto* samples = reinterpret_cast<Sample*>(row);
  for (std::size_t i = layout.samples; i < values; ++i) {
    samples[i] = static_cast<Sample>(samples[i] + samples[i - layout.samples]);
  }
}

// Predictor 3: the differences of the bytes of a row, all highest bytes first.
void undo_float_differences(std::uint8_t* row, const Layout& layout,
                            std::vector<std::uint8_t>& planes) {
  const std::size_t values = std::size_t{layout.block_width} * layout.samples;
  planes.assign(row, row + values * sizeof(float));
  for (std::size_t i = layout.samples; i < planes.size(); ++i) {
    planes[i] = static_cast<std::uint8_t>(planes[i] + planes[i - layout.samples]);
  }
  for (std::size_t i = 0; i < values; ++i) {
    for (std::size_t byte = 0; byte < sizeof(float); ++byte) {
      const std::size_t place = std::endian::native == std::endian::little ? 3 - byte : byte;
      row[i * sizeof(float) + place] = planes[byte * values + i];
    }
  }
}

void to_native_order(std::vector<std::uint8_t>& block, const Layout& layout) {
  const std::size_t bytes = layout.bits / 8;
  if (bytes < 2 || layout.predictor == 3) return;  // predictor 3 has an order of its own
  if (layout.big_endian == (std::endian::native == std::endian::big)) return;
  for (std::size_t at = 0; at + bytes <= block.size(); at += bytes) {
    std::reverse(block.begin() + static_cast<std::ptrdiff_t>(at),
                 block.begin() + static_cast<std::ptrdiff_t>(at + bytes));
  }
}

void undo_predictor(std::vector<std::uint8_t>& block, const Layout& layout) {
  if (layout.predictor == 1) return;
  std::vector<std::uint8_t> planes;
  for (std::size_t at = 0; at < block.size(); at += layout.bytes_per_row()) {
    if (layout.predictor == 3) {
      undo_float_differences(&block[at], layout, planes);
    } else if (layout.bits == 32) {
      undo_differences<std::uint32_t>(&block[at], layout);
    } else if (layout.bits == 16) {
      undo_differences<std::uint16_t>(&block[at], layout);
    } else {
      undo_differences<std::uint8_t>(&block[at], layout);
    }
  }
}

// One row of a block to the image: bits to bytes, RGB to BGR, alpha dropped.
void place_row(const std::uint8_t* row, const Layout& layout, std::size_t pixels,
               std::uint8_t* to) {
  if (layout.bits == 1) {
    const std::uint32_t flip = layout.photometric == kWhiteIsZero ? 1 : 0;
    for (std::size_t x = 0; x < pixels; ++x) {
      to[x] = ((row[x / 8] >> (7 - x % 8) & 1U) ^ flip) != 0 ? 255 : 0;
    }
    return;
  }
  const std::size_t bytes = layout.bits / 8;
  const std::size_t channels = layout.samples >= 3 ? 3 : 1;
  for (std::size_t x = 0; x < pixels; ++x, row += bytes * layout.samples) {
    for (std::size_t c = 0; c < channels; ++c, to += bytes) {
      std::memcpy(to, row + bytes * (channels - 1 - c), bytes);
    }
  }
}

void apply_palette(cv::Mat& image, const Directory& directory) {
  std::vector<cv::Vec3b> palette;
  for (std::size_t i = 0; i < 256; ++i) {  // all reds, all greens, all blues, of 16 bits
    const auto value = [&](std::size_t c) {
      return static_cast<std::uint8_t>(directory.get(kColorMap, 0, c * 256 + i) / 257);
    };
    palette.emplace_back(value(2), value(1), value(0));
  }
  cv::Mat color(image.size(), CV_8UC3);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      color.at<cv::Vec3b>(y, x) = palette[image.at<std::uint8_t>(y, x)];
    }
  }
  image = color;
}

void place_block(const std::vector<std::uint8_t>& block, const Layout& layout, std::size_t left,
                 std::size_t top, cv::Mat& image) {
  const std::size_t pixels = std::min<std::size_t>(layout.block_width, layout.width - left);
  const std::size_t rows = std::min<std::size_t>(layout.block_height, layout.height - top);
  for (std::size_t y = 0; y < rows; ++y) {
    place_row(&block[y * layout.bytes_per_row()], layout, pixels,
              image.ptr(static_cast<int>(top + y)) + left * image.elemSize());
  }
}

cv::Mat decode(std::string_view bytes) {
  const Directory directory(bytes);
  const Layout layout = parse(directory);
  const int depth = layout.format == kFloat ? CV_32F : layout.bits == 16 ? CV_16U : CV_8U;
  cv::Mat image(static_cast<int>(layout.height), static_cast<int>(layout.width),
                CV_MAKETYPE(depth, layout.samples >= 3 ? 3 : 1));
  std::vector<std::uint8_t> block;
  for (std::size_t i = 0; i < layout.blocks_across() * layout.blocks_down(); ++i) {
    const std::size_t left = i % layout.blocks_across() * layout.block_width;
    const std::size_t top = i / layout.blocks_across() * layout.block_height;
    // The last strip is as high as is needed, tiles are always whole.
    const std::size_t rows = layout.tiled
                                 ? layout.block_height
                                 : std::min<std::size_t>(layout.block_height, layout.height - top);
    block.resize(rows * layout.bytes_per_row());
    const std::string_view packed =
        bytes.substr(directory.get(layout.offsets(), 0, i), directory.get(layout.sizes(), 0, i));
    if (!unpack_tiff_block(layout.compression, packed, block)) {
      damaged("a strip or tile cannot be unpacked");
    }
    to_native_order(block, layout);
    undo_predictor(block, layout);
    place_block(block, layout, left, top, image);
  }
  if (layout.photometric == kPalette) apply_palette(image, directory);
  if (layout.photometric == kWhiteIsZero && layout.bits > 1 && layout.format == kUnsigned) {
    cv::bitwise_not(image, image);
  }
  return image;
}

}  // namespace

const ImageCodec kTiffCodec = {recognises, inspect, decode};

}  // namespace dxslam
