// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include <fmt/format.h>

#include <jerror.h>
#include <jpeglib.h>
#include <csetjmp>
#include <cstdio>  // jpeglib.h needs FILE and size_t
#include <cstdlib>
#include <cstring>

#include "core/error.h"
#include "io/image_codecs/byte_order.h"
#include "io/image_codecs/image_codec.h"
#include "io/primitives/limits.h"

namespace dxslam {
namespace {

bool recognises(std::string_view start) { return start.substr(0, 3) == "\xFF\xD8\xFF"; }

bool is_restart(std::uint32_t marker) { return marker >= 0xD0 && marker <= 0xD7; }
bool is_frame_header(std::uint32_t marker) {
  return marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
}

// Where the next marker begins, at or behind `at`: coded pixels hold FF only before 00 and
// restarts.
std::size_t next_marker(std::string_view bytes, std::size_t at) {
  while ((at = bytes.find('\xFF', at)) != std::string_view::npos && at + 1 < bytes.size()) {
    const std::uint32_t marker = byte_at(bytes, at + 1);
    if (marker != 0 && marker != 0xFF && !is_restart(marker)) return at;
    at += marker == 0xFF ? 1 : 2;
  }
  throw InputError("truncated JPEG, expected the end marker FFD9");
}

// Walks the markers up to the end of the image; what lies behind (previews, videos) is no concern.
// The decoder would fill up a truncated image, and take minutes for thousands of scans.
cv::Size_<std::uint32_t> inspect(std::string_view bytes) {
  cv::Size_<std::uint32_t> size;
  bool has_size = false;
  int scans = 0;
  for (std::size_t at = 2;;) {
    if (!has_size && at < bytes.size() && byte_at(bytes, at) != 0xFF) {
      throw InputError(fmt::format("damaged JPEG, no marker at byte {}", at));
    }
    at = next_marker(bytes, at);
    const std::uint32_t marker = byte_at(bytes, at + 1);
    if (marker == 0xD9) break;
    if (at + 4 > bytes.size()) throw InputError("truncated JPEG, expected the end marker FFD9");
    if (is_frame_header(marker) && at + 9 <= bytes.size()) {
      if (has_size) throw InputError("damaged JPEG, two frame headers");
      size = {big_endian16(bytes, at + 7), big_endian16(bytes, at + 5)};
      has_size = true;
    }
    if (marker == 0xDA && ++scans > limits::kJpegScans) {
      throw InputError(
          fmt::format("JPEG of more than {} scans, expected a usual progressive one "
                      "of some 10",
                      limits::kJpegScans));
    }
    at += 2 + std::size_t{big_endian16(bytes, at + 2)};
  }
  if (!has_size) throw InputError("damaged JPEG, no frame header");
  return size;
}

// libjpeg's own handlers would print, and exit() on an error.
struct Errors {
  jpeg_error_mgr base;  // first, so that a pointer to it is one to Errors
  std::jmp_buf jump;
  bool damaged;
};

Errors& errors_of(j_common_ptr info) { return *reinterpret_cast<Errors*>(info->err); }

[[noreturn]] void on_error(j_common_ptr info) { std::longjmp(errors_of(info).jump, 1); }

// Warnings that say that a part of the picture is made up; the others are harmless.
void on_message(j_common_ptr info, int level) {
  if (level >= 0) return;
  switch (info->err->msg_code) {
    case JWRN_HIT_MARKER:
    case JWRN_HUFF_BAD_CODE:
    case JWRN_MUST_RESYNC:
    case JWRN_JPEG_EOF:
      errors_of(info).damaged = true;
      break;
    default:
      break;
  }
}

void use_errors(j_common_ptr info, Errors& errors) {
  info->err = jpeg_std_error(&errors.base);
  errors.base.error_exit = on_error;
  errors.base.emit_message = on_message;
  errors.base.output_message = [](j_common_ptr) {};
  errors.damaged = false;
}

J_COLOR_SPACE output_space(const jpeg_decompress_struct& info) {
  if (info.num_components == 1) return JCS_GRAYSCALE;
  return info.num_components == 4 ? JCS_CMYK : JCS_EXT_BGR;
}

// A jump passes no destructor: all that has one belongs to the caller.
bool read_image(jpeg_decompress_struct& info, Errors& errors, std::string_view bytes,
                cv::Mat& image) {
  if (setjmp(errors.jump) != 0) return false;
  jpeg_create_decompress(&info);
  info.mem->max_memory_to_use = static_cast<long>(limits::kDecoderBytes);
  jpeg_mem_src(&info, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
  jpeg_read_header(&info, TRUE);
  info.out_color_space = output_space(info);
  jpeg_start_decompress(&info);
  image.create(static_cast<int>(info.output_height), static_cast<int>(info.output_width),
               CV_8UC(info.output_components));
  while (info.output_scanline < info.output_height) {
    JSAMPROW row = image.ptr(static_cast<int>(info.output_scanline));
    jpeg_read_scanlines(&info, &row, 1);
  }
  jpeg_finish_decompress(&info);
  return !errors.damaged;
}

// Printers' colours; Adobe, which alone writes these, stores them inverted.
cv::Mat from_cmyk(const cv::Mat& cmyk) {
  cv::Mat image(cmyk.size(), CV_8UC3);
  for (int y = 0; y < cmyk.rows; ++y) {
    for (int x = 0; x < cmyk.cols; ++x) {
      const auto& from = cmyk.at<cv::Vec4b>(y, x);
      auto& to = image.at<cv::Vec3b>(y, x);
      for (int c = 0; c < 3; ++c) to[2 - c] = static_cast<std::uint8_t>(from[c] * from[3] / 255);
    }
  }
  return image;
}

struct Decoder {
  Decoder() { use_errors(reinterpret_cast<j_common_ptr>(&info), errors); }
  ~Decoder() { jpeg_destroy_decompress(&info); }
  Decoder(const Decoder&) = delete;
  Decoder& operator=(const Decoder&) = delete;

  jpeg_decompress_struct info{};
  Errors errors{};
};

cv::Mat decode(std::string_view bytes) {
  Decoder decoder;
  cv::Mat image;
  if (!read_image(decoder.info, decoder.errors, bytes, image))
    throw InputError("damaged JPEG, its pixels cannot be decoded");
  return image.channels() == 4 ? from_cmyk(image) : image;
}

bool write_image(jpeg_compress_struct& info, Errors& errors, const cv::Mat& image, int quality,
                 unsigned char*& buffer, unsigned long& size) {
  if (setjmp(errors.jump) != 0) return false;
  jpeg_create_compress(&info);
  jpeg_mem_dest(&info, &buffer, &size);
  info.image_width = static_cast<JDIMENSION>(image.cols);
  info.image_height = static_cast<JDIMENSION>(image.rows);
  info.input_components = image.channels();
  info.in_color_space = image.channels() == 3 ? JCS_EXT_BGR : JCS_GRAYSCALE;
  jpeg_set_defaults(&info);
  jpeg_set_quality(&info, quality, TRUE);
  jpeg_start_compress(&info, TRUE);
  while (info.next_scanline < info.image_height) {
    auto* row = const_cast<JSAMPROW>(image.ptr(static_cast<int>(info.next_scanline)));
    jpeg_write_scanlines(&info, &row, 1);
  }
  jpeg_finish_compress(&info);
  return true;
}

}  // namespace

const ImageCodec kJpegCodec = {recognises, inspect, decode};

std::string encode_jpeg(const cv::Mat& image, int quality) {
  require(!image.empty() && (image.type() == CV_8UC1 || image.type() == CV_8UC3),
          "a picture for JPEG must be 8-bit grey or colour");
  jpeg_compress_struct info{};
  Errors errors{};
  use_errors(reinterpret_cast<j_common_ptr>(&info), errors);
  unsigned char* buffer = nullptr;
  unsigned long size = 0;
  const bool done = write_image(info, errors, image, quality, buffer, size);
  jpeg_destroy_compress(&info);
  std::string bytes;
  if (done) bytes.assign(reinterpret_cast<const char*>(buffer), size);
  std::free(buffer);
  require(done, "a picture could not be written as JPEG");
  return bytes;
}

}  // namespace dxslam
