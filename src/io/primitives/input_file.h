// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstddef>
#include <string>

namespace dxslam {

/// A regular file that is open for reading; closed with the object. `expected` says in messages
/// what should be there, e.g. "a map of dxslam".
class InputFile {
 public:
  /// Throws InputError if there is no such file, if it cannot be read, or if it is none: a folder,
  /// a device, a pipe (which is not waited for).
  InputFile(const std::string& path, const std::string& expected);
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  int descriptor() const { return descriptor_; }
  /// Bytes, when it was opened.
  std::size_t size() const { return size_; }
  /// The next bytes, as many as there are up to `bytes`. Throws InputError if they cannot be read.
  std::size_t read(char* to, std::size_t bytes) const;
  /// Throws the InputError of something that could not be done with it, by errno.
  [[noreturn]] void fail() const;

 private:
  std::string path_;
  std::string expected_;
  int descriptor_ = -1;
  std::size_t size_ = 0;
};

}  // namespace dxslam
