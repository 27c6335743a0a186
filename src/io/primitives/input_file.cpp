// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/primitives/input_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "core/error.h"

namespace dxslam {

// Not blocking: opening a pipe must not wait for somebody to write to it.
InputFile::InputFile(const std::string& path, const std::string& expected)
    : path_(path),
      expected_(expected),
      descriptor_(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {
  if (descriptor_ < 0) fail();
  struct stat status{};
  if (::fstat(descriptor_, &status) == 0 && S_ISREG(status.st_mode)) {
    size_ = static_cast<std::size_t>(status.st_size);
    return;
  }
  ::close(descriptor_);
  throw InputError(fmt::format("{}: not a regular file, expected {}", path_, expected_));
}

InputFile::~InputFile() { ::close(descriptor_); }

std::size_t InputFile::read(char* to, std::size_t bytes) const {
  std::size_t total = 0;
  while (total < bytes) {
    const ssize_t done = ::read(descriptor_, to + total, bytes - total);
    if (done < 0 && errno == EINTR) continue;
    if (done < 0) fail();
    if (done == 0) break;
    total += static_cast<std::size_t>(done);
  }
  return total;
}

void InputFile::fail() const {
  const int error = errno;
  if (error == ENOENT) {
    throw InputError(fmt::format("{}: no such file, expected {}", path_, expected_));
  }
  throw InputError(
      fmt::format("{}: cannot be read: {}, expected {}", path_, std::strerror(error), expected_));
}

}  // namespace dxslam
