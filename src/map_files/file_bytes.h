// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <string>

namespace dxslam {

/// The whole of a file as it was when it was opened, even if it is replaced meanwhile. Unlike
/// read_file() made for hundreds of megabytes: nothing is cleared or copied twice.
class FileBytes {
 public:
  /// Throws InputError if the file is missing, is no regular file, cannot be read or is larger than
  /// `max_bytes`; `expected` says what it should have been.
  FileBytes(const std::string& path, const std::string& expected, std::size_t max_bytes);

  const char* data() const { return bytes_.get(); }
  std::size_t size() const { return size_; }

 private:
  struct Free {
    void operator()(char* bytes) const { std::free(bytes); }
  };
  std::unique_ptr<char, Free> bytes_;
  std::size_t size_ = 0;
};

}  // namespace dxslam
