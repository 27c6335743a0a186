// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstdint>
#include <string>

namespace dxslam {

/// A file read in pieces, of any size. Not thread-safe.
class RandomAccessFile {
 public:
  /// Throws InputError if it cannot be opened or is no regular file.
  explicit RandomAccessFile(const std::string& path);
  ~RandomAccessFile();
  RandomAccessFile(const RandomAccessFile&) = delete;
  RandomAccessFile& operator=(const RandomAccessFile&) = delete;

  const std::string& path() const { return path_; }
  std::uint64_t size() const { return size_; }
  /// Exactly `count` bytes from `at`; throws InputError if the file ends before.
  std::string read(std::uint64_t at, std::uint64_t count) const;

 private:
  std::string path_;
  int file_ = -1;
  std::uint64_t size_ = 0;
};

}  // namespace dxslam
