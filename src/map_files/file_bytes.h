// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstddef>
#include <cstdlib>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

namespace dxslam {

/// The whole of a file as it was when it was opened, even if it is replaced meanwhile. Unlike
/// read_file() made for hundreds of megabytes: nothing is cleared or copied twice.
class FileBytes {
 public:
  /// Looks at the first bytes of a file, and its size, before the rest is read; throws if it is
  /// none of the kind.
  using CheckStart = std::function<void(std::string_view start, std::size_t size)>;

  /// Throws InputError if the file is missing, is no regular file, cannot be read, is larger than
  /// `max_bytes` or than the memory; `expected` says what it should have been. `check_start` gets
  /// up to `start_bytes`.
  FileBytes(const std::string& path, const std::string& expected, std::size_t max_bytes,
            std::size_t start_bytes, const CheckStart& check_start);

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
