// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/primitives/picture_mark.h"

#include <cstdint>
#include <utility>

#include "io/primitives/crc32.h"

namespace dxslam {
namespace {

constexpr std::string_view kJpegBegin("\xFF\xD8", 2);
constexpr std::string_view kPngBegin("\x89PNG\r\n\x1a\n", 8);
constexpr std::size_t kPngHeaderEnd = 33;  // signature and IHDR, which must be the first chunk

void append_big_endian(std::uint32_t value, int bytes, std::string& text) {
  for (int byte = bytes - 1; byte >= 0; --byte) text += static_cast<char>(value >> (8 * byte));
}

// A comment segment.
std::string jpeg_mark(std::string_view software) {
  std::string mark = "\xFF\xFE";
  append_big_endian(static_cast<std::uint32_t>(software.size()) + 2, 2, mark);
  return mark.append(software);
}

// A chunk of text, with the keyword that PNG has for this.
std::string png_mark(std::string_view software) {
  std::string body = "tEXtSoftware";
  body += '\0';
  body += software;
  std::string mark;
  append_big_endian(static_cast<std::uint32_t>(body.size()) - 4, 4, mark);
  mark += body;
  append_big_endian(crc32_of(body), 4, mark);
  return mark;
}

}  // namespace

std::string mark_picture(std::string picture, std::string_view software) {
  if (picture.starts_with(kJpegBegin)) picture.insert(kJpegBegin.size(), jpeg_mark(software));
  if (picture.starts_with(kPngBegin) && picture.size() > kPngHeaderEnd) {
    picture.insert(kPngHeaderEnd, png_mark(software));
  }
  return picture;
}

FileKind marked_picture_kind(std::string name, const std::string& software) {
  const auto matches = [jpeg = jpeg_mark(software),
                        png = png_mark(software)](std::string_view head) {
    if (head.starts_with(kJpegBegin)) return head.substr(kJpegBegin.size()).starts_with(jpeg);
    return head.starts_with(kPngBegin) && head.size() > kPngHeaderEnd &&
           head.substr(kPngHeaderEnd).starts_with(png);
  };
  return {std::move(name), matches, {".png", ".jpg", ".jpeg"}};
}

}  // namespace dxslam
