// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/primitives/file_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <system_error>

#include "core/error.h"

namespace dxslam {
namespace {

bool same_file(int open_file, const std::string& path) {
  struct stat a{};
  struct stat b{};
  return ::fstat(open_file, &a) == 0 && ::stat(path.c_str(), &b) == 0 && a.st_dev == b.st_dev &&
         a.st_ino == b.st_ino;
}

}  // namespace

// The last owner may have removed the file between opening and locking it here: then its lock means
// nothing.
FileLock::FileLock(std::string path, const std::string& in_use) : path_(std::move(path)) {
  do {
    if (file_ >= 0) ::close(file_);
    file_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (file_ < 0) throw std::system_error(errno, std::generic_category());
    if (::flock(file_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
      ::close(file_);
      throw InputError(in_use);
    }
  } while (!same_file(file_, path_));
  const std::filesystem::path folder = std::filesystem::path(path_).parent_path();
  folder_ = ::open(folder.empty() ? "." : folder.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC);
}

FileLock::~FileLock() {
  const std::string name = std::filesystem::path(path_).filename().string();
  ::unlinkat(folder_, name.c_str(), 0);  // before others can take it
  ::close(folder_);
  ::close(file_);
}

}  // namespace dxslam
