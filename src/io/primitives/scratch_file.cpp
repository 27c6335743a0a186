// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/primitives/scratch_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/magic.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <utility>
#include <vector>

#include "core/error.h"

namespace dxslam {
namespace {

bool is_on_disk(const std::string& folder) {
  struct statfs status{};
  if (::statfs(folder.c_str(), &status) != 0) return false;
  const auto type = static_cast<unsigned long>(status.f_type);
  return type != TMPFS_MAGIC && type != RAMFS_MAGIC;
}

// Without a name from the start: nobody finds it, and it is gone with its descriptor.
int make_unnamed_file(const std::string& folder) {
  std::string name = (std::filesystem::path(folder) / "dxslam-XXXXXX").string();
  const int file = ::mkostemp(name.data(), O_CLOEXEC);
  if (file >= 0) ::unlink(name.c_str());
  return file;
}

int make_file_on_disk() {
  std::vector<std::string> folders;
  if (const char* wanted = std::getenv("TMPDIR"); wanted != nullptr) folders.emplace_back(wanted);
  folders.emplace_back("/var/tmp");
  std::error_code error;
  folders.push_back(std::filesystem::temp_directory_path(error).string());
  for (const std::string& folder : folders) {
    if (folder.empty() || !is_on_disk(folder)) continue;
    const int file = make_unnamed_file(folder);
    if (file >= 0) return file;
  }
  return -1;
}

}  // namespace

ScratchFile::ScratchFile(std::string folder) : folder_(std::move(folder)) {}

ScratchFile::~ScratchFile() {
  if (file_ >= 0) ::close(file_);
}

ScratchFile::ScratchFile(ScratchFile&& other) noexcept
    : folder_(std::move(other.folder_)), file_(std::exchange(other.file_, -1)) {}

ScratchFile& ScratchFile::operator=(ScratchFile&& other) noexcept {
  std::swap(folder_, other.folder_);
  std::swap(file_, other.file_);
  return *this;
}

bool ScratchFile::write(const void* data, std::size_t bytes, std::uint64_t at) {
  if (file_ < 0) file_ = folder_.empty() ? make_file_on_disk() : make_unnamed_file(folder_);
  if (file_ < 0) return false;
  const char* from = static_cast<const char*>(data);
  while (bytes > 0) {
    const ssize_t done = ::pwrite(file_, from, bytes, static_cast<off_t>(at));
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) return false;
    from += done;
    at += static_cast<std::uint64_t>(done);
    bytes -= static_cast<std::size_t>(done);
  }
  return true;
}

void ScratchFile::read(void* data, std::size_t bytes, std::uint64_t at) const {
  char* to = static_cast<char*>(data);
  while (bytes > 0) {
    const ssize_t done = ::pread(file_, to, bytes, static_cast<off_t>(at));
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) {
      throw InputError(fmt::format("a temporary file cannot be read: {}",
                                   done < 0 ? std::strerror(errno) : "it is too short"));
    }
    to += done;
    at += static_cast<std::uint64_t>(done);
    bytes -= static_cast<std::size_t>(done);
  }
}

}  // namespace dxslam
