// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace dxslam {

/// A file that is written while it grows. What is appended is handed to the system at once, so it
/// survives a crash of the program. One thread at a time.
class GrowingFile {
 public:
  /// Creates or empties the file; throws InputError if that fails.
  explicit GrowingFile(std::string path);
  ~GrowingFile();
  GrowingFile(const GrowingFile&) = delete;
  GrowingFile& operator=(const GrowingFile&) = delete;

  /// Throws InputError if not all of it could be written (full disk); the file then ends where it
  /// ended before.
  void append(std::string_view bytes);
  std::uint64_t size() const { return static_cast<std::uint64_t>(size_); }

 private:
  std::string path_;
  int file_ = -1;
  std::int64_t size_ = 0;
};

}  // namespace dxslam
