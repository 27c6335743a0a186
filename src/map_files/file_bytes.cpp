// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "map_files/file_bytes.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

#include "core/error.h"
#include "core/parallel.h"
#include "io/primitives/input_file.h"
#include "map_files/huge_pages.h"

namespace dxslam {
namespace {

constexpr std::size_t kPiece = std::size_t{2} << 20;  // bytes read at a time
constexpr std::size_t kPiecesForOneThread = 4;

// Whether all of `size` bytes at `offset` could be read.
bool read_piece(int file, char* to, std::size_t offset, std::size_t size) {
  while (size > 0) {
    const ssize_t got = ::pread(file, to, size, static_cast<off_t>(offset));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    to += got;
    offset += static_cast<std::size_t>(got);
    size -= static_cast<std::size_t>(got);
  }
  return true;
}

}  // namespace

FileBytes::FileBytes(const std::string& path, const std::string& expected, std::size_t max_bytes,
                     std::size_t start_bytes, const CheckStart& check_start) {
  const InputFile file(path, expected);
  size_ = file.size();
  if (size_ > max_bytes) {
    throw InputError(fmt::format("{}: {} bytes, expected {} of at most {} bytes", path, size_,
                                 expected, max_bytes));
  }
  const auto cannot_be_read = [&] {
    return InputError(fmt::format("{}: cannot be read, expected {}", path, expected));
  };
  std::string start(std::min(size_, start_bytes), '\0');
  if (!read_piece(file.descriptor(), start.data(), 0, start.size())) throw cannot_be_read();
  check_start(start, size_);
  bytes_.reset(static_cast<char*>(std::malloc(size_ + 1)));  // never of size 0
  if (bytes_ == nullptr) {
    throw InputError(fmt::format("{}: {} bytes, more than there is memory", path, size_));
  }
  advise_huge_pages(bytes_.get(), size_);
  const std::size_t pieces = (size_ + kPiece - 1) / kPiece;
  in_parallel(pieces, pieces > kPiecesForOneThread ? helpful_threads() : 1, [&](std::size_t i) {
    const std::size_t begin = i * kPiece;
    if (read_piece(file.descriptor(), bytes_.get() + begin, begin, std::min(kPiece, size_ - begin)))
      return;
    throw cannot_be_read();
  });
}

}  // namespace dxslam
