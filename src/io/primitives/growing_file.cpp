// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/primitives/growing_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "core/error.h"

namespace dxslam {

GrowingFile::GrowingFile(std::string path)
    : path_(std::move(path)),
      file_(::open(path_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_APPEND | O_CLOEXEC, 0666)) {
  if (file_ < 0) {
    throw InputError(fmt::format("{}: cannot be written: {}", path_, std::strerror(errno)));
  }
}

GrowingFile::~GrowingFile() { ::close(file_); }

void GrowingFile::append(std::string_view bytes) {
  const auto size = size_ + static_cast<std::int64_t>(bytes.size());
  while (!bytes.empty()) {
    const ssize_t written = ::write(file_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      const int error = errno;
      static_cast<void>(::ftruncate(file_, size_));  // less is always possible
      throw InputError(fmt::format("{}: cannot be written: {}", path_, std::strerror(error)));
    }
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  size_ = size;
}

}  // namespace dxslam
