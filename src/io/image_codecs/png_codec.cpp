// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include <fmt/format.h>
#include <png.h>
#include <zlib.h>

#include <algorithm>
#include <csetjmp>
#include <cstring>

#include "core/error.h"
#include "io/image_codecs/byte_order.h"
#include "io/image_codecs/image_codec.h"
#include "io/primitives/limits.h"
#include "io/primitives/text_file.h"

namespace dxslam {
namespace {

constexpr std::string_view kSignature("\x89PNG\r\n\x1a\n", 8);

bool recognises(std::string_view start) { return start.substr(0, 8) == kSignature; }

// Walks the chunks: length, type, data, checksum. The decoder would fill up a truncated image.
cv::Size_<std::uint32_t> inspect(std::string_view bytes) {
  cv::Size_<std::uint32_t> size;
  std::size_t at = kSignature.size();
  for (bool first = true;; first = false) {
    if (bytes.size() - at < 12)
      throw InputError("truncated PNG, expected an IEND chunk at its end");
    const std::size_t length = big_endian32(bytes, at);
    const std::string_view type = bytes.substr(at + 4, 4);
    if (length > bytes.size() - at - 12) {
      throw InputError(fmt::format("truncated PNG, {} bytes are missing at its end",
                                   length - (bytes.size() - at - 12)));
    }
    const auto* data = reinterpret_cast<const Bytef*>(bytes.data() + at + 4);
    if (crc32(0, data, static_cast<uInt>(length + 4)) != big_endian32(bytes, at + 8 + length)) {
      throw InputError(fmt::format("damaged PNG, wrong checksum of chunk {}", in_quotes(type)));
    }
    if (first) {
      if (type != "IHDR" || length != 13) throw InputError("damaged PNG, no IHDR chunk first");
      size = {big_endian32(bytes, at + 8), big_endian32(bytes, at + 12)};
    }
    if (type == "IEND") return size;
    at += length + 12;
  }
}

struct Reader {
  std::string_view bytes;
  std::size_t at = 0;
};

void read_bytes(png_structp png, png_bytep target, std::size_t count) {
  auto& reader = *static_cast<Reader*>(png_get_io_ptr(png));
  if (count > reader.bytes.size() - reader.at) png_error(png, "end of file");
  std::memcpy(target, reader.bytes.data() + reader.at, count);
  reader.at += count;
}

// libpng may only be left by a jump; it would print without these.
[[noreturn]] void on_error(png_structp png, png_const_charp) { png_longjmp(png, 1); }
void on_warning(png_structp, png_const_charp) {}

void set_up(png_structp png, Reader& reader) {
  png_set_read_fn(png, &reader, read_bytes);
  png_set_user_limits(png, limits::kImageSide, limits::kImageSide);
  // Colour profiles, texts and the like are not looked at, and inspect() knows all checksums.
  png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_NEVER, nullptr, 0);
  png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
  png_set_crc_action(png, PNG_CRC_QUIET_USE, PNG_CRC_QUIET_USE);
}

int set_up_pixels(png_structp png, png_infop info) {
  const int colour = png_get_color_type(png, info);
  const bool wide = png_get_bit_depth(png, info) == 16;
  const bool grey = (colour & PNG_COLOR_MASK_COLOR) == 0;
  if (colour == PNG_COLOR_TYPE_PALETTE) png_set_palette_to_rgb(png);
  if (colour == PNG_COLOR_TYPE_GRAY) png_set_expand_gray_1_2_4_to_8(png);
  if (colour != PNG_COLOR_TYPE_GRAY) png_set_strip_alpha(png);
  if (wide) png_set_swap(png);
  if (!grey) png_set_bgr(png);
  png_set_interlace_handling(png);
  png_read_update_info(png, info);
  return CV_MAKETYPE(wide ? CV_16U : CV_8U, grey ? 1 : 3);
}

// A jump passes no destructor: all that has one belongs to the caller.
bool read_image(png_structp png, png_infop info, Reader& reader, cv::Mat& image,
                std::vector<png_bytep>& rows) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  set_up(png, reader);
  png_read_info(png, info);
  const int type = set_up_pixels(png, info);
  image.create(static_cast<int>(png_get_image_height(png, info)),
               static_cast<int>(png_get_image_width(png, info)), type);
  if (png_get_rowbytes(png, info) != static_cast<std::size_t>(image.cols) * image.elemSize()) {
    return false;
  }
  rows.resize(static_cast<std::size_t>(image.rows));
  for (int y = 0; y < image.rows; ++y) rows[static_cast<std::size_t>(y)] = image.ptr(y);
  png_read_image(png, rows.data());
  return true;
}

struct Decoder {
  Decoder()
      : png(png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, on_error, on_warning)),
        info(png == nullptr ? nullptr : png_create_info_struct(png)) {}
  ~Decoder() { png_destroy_read_struct(&png, &info, nullptr); }
  Decoder(const Decoder&) = delete;
  Decoder& operator=(const Decoder&) = delete;

  png_structp png;
  png_infop info;
};

cv::Mat decode(std::string_view bytes) {
  const Decoder decoder;
  Reader reader{bytes};
  cv::Mat image;
  std::vector<png_bytep> rows;
  if (decoder.info == nullptr || !read_image(decoder.png, decoder.info, reader, image, rows))
    throw InputError("damaged PNG, its pixels cannot be decoded");
  return image;
}

void append_bytes(png_structp png, png_bytep data, std::size_t count) {
  static_cast<std::string*>(png_get_io_ptr(png))
      ->append(reinterpret_cast<const char*>(data), count);
}

bool write_image(png_structp png, png_infop info, const cv::Mat& image, int level,
                 std::string& bytes, std::vector<png_const_bytep>& rows) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_write_fn(png, &bytes, append_bytes, nullptr);
  png_set_compression_level(png, level);
  png_set_compression_strategy(png, Z_RLE);  // as good as the others on images, and faster
  png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
  png_set_IHDR(png, info, static_cast<png_uint_32>(image.cols),
               static_cast<png_uint_32>(image.rows), static_cast<int>(8 * image.elemSize1()),
               image.channels() == 3 ? PNG_COLOR_TYPE_RGB : PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_BASE, PNG_FILTER_TYPE_BASE);
  png_write_info(png, info);
  if (image.channels() == 3) png_set_bgr(png);
  if (image.elemSize1() == 2) png_set_swap(png);
  for (int y = 0; y < image.rows; ++y) rows.push_back(image.ptr(y));
  png_write_image(png, const_cast<png_bytepp>(rows.data()));
  png_write_end(png, info);
  return true;
}

}  // namespace

const ImageCodec kPngCodec = {recognises, inspect, decode};

std::string encode_png(const cv::Mat& image, int level) {
  require(!image.empty() &&
              (image.type() == CV_8UC1 || image.type() == CV_8UC3 || image.type() == CV_16UC1),
          "a picture for PNG must be 8-bit grey or colour, or 16-bit grey");
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, on_error, on_warning);
  png_infop info = png == nullptr ? nullptr : png_create_info_struct(png);
  std::string bytes;
  std::vector<png_const_bytep> rows;
  const bool done = info != nullptr && write_image(png, info, image, level, bytes, rows);
  png_destroy_write_struct(&png, &info);
  require(done, "a picture could not be written as PNG");
  return bytes;
}

}  // namespace dxslam
