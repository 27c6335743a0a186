// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/primitives/temporary_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/random.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <climits>
#include <cstdio>
#include <filesystem>
#include <system_error>
#include <utility>

namespace dxslam {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kMark = ".dxslam-";
constexpr std::string_view kEnding = ".tmp";
constexpr std::string_view kAlphabet = "abcdefghijklmnopqrstuvwxyz234567";
constexpr std::size_t kRandomLetters = 16;   // 80 bits
constexpr std::size_t kLongestPrefix = 200;  // bytes; names may have 255
constexpr int kAttempts = 100;

[[noreturn]] void fail(int error) { throw std::system_error(error, std::generic_category()); }

std::string random_letters() {
  std::array<unsigned char, kRandomLetters> bytes{};
  if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) fail(errno);
  std::string letters;
  for (const unsigned char byte : bytes) letters += kAlphabet[byte % kAlphabet.size()];
  return letters;
}

// Of the file's name; cut between characters, as some file systems insist on UTF-8.
std::string prefix_of(const std::string& name) {
  std::size_t length = std::min(name.size(), kLongestPrefix);
  while (length > 0 && length < name.size() &&
         (static_cast<unsigned char>(name[length]) & 0xC0U) == 0x80) {
    --length;
  }
  return name.substr(0, length) + std::string(kMark);
}

fs::path folder_of(const fs::path& target) {
  return target.has_parent_path() ? target.parent_path() : fs::path(".");
}

std::string new_name_for(const std::string& target) {
  const fs::path path(target);
  const std::string name = path.filename().string();
  return (folder_of(path) / fmt::format("{}{}{}", prefix_of(name), random_letters(), kEnding))
      .string();
}

// Whether new_name_for() gave the name, for the target with that prefix or, if empty, for any.
bool is_temporary_name(std::string_view name, const std::string& prefix) {
  const std::size_t tail = kRandomLetters + kEnding.size();
  if (name.size() <= tail + kMark.size() || name.substr(name.size() - kEnding.size()) != kEnding) {
    return false;
  }
  const std::string_view begin = name.substr(0, name.size() - tail);
  const std::string_view letters = name.substr(begin.size(), kRandomLetters);
  if (letters.find_first_not_of(kAlphabet) != std::string_view::npos) return false;
  return prefix.empty() ? begin.substr(begin.size() - kMark.size()) == kMark : begin == prefix;
}

// Whoever writes a temporary file holds its lock, also where the process cannot be seen from here
// (another container on the same folder).
void remove_unless_locked(const std::string& temporary) {
  const int file = ::open(temporary.c_str(), O_WRONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (file < 0) return;
  if (::flock(file, LOCK_EX | LOCK_NB) == 0) ::unlink(temporary.c_str());
  ::close(file);
}

}  // namespace

TemporaryFile::TemporaryFile(const std::string& target, Kind kind) : target_(target) {
  if (fs::path(target).filename().string().size() > NAME_MAX) fail(ENAMETOOLONG);
  if (kind == Kind::kNamed || !make_unnamed()) make_named();
}

TemporaryFile::~TemporaryFile() {
  if (!name_.empty()) ::unlink(name_.c_str());
  if (file_ >= 0) ::close(file_);
}

// A file without a name vanishes with the process. False where there is no such thing, or no way to
// name it later.
bool TemporaryFile::make_unnamed() {
  static const bool can_be_named = ::access("/proc/self/fd", X_OK) == 0;
  if (!can_be_named) return false;
  file_ = ::open(folder_of(target_).c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666);
  if (file_ < 0) return false;
  ::flock(file_, LOCK_EX | LOCK_NB);
  return true;
}

void TemporaryFile::make_named() {
  for (int i = 0; i < kAttempts; ++i) {
    const std::string name = new_name_for(target_);
    file_ = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file_ < 0 && errno == EEXIST) continue;
    if (file_ < 0) fail(errno);
    ::flock(file_, LOCK_EX | LOCK_NB);  // until it is closed
    struct stat status{};
    if (::fstat(file_, &status) == 0 && status.st_nlink > 0) {
      name_ = name;
      return;
    }
    ::close(std::exchange(file_, -1));  // taken for a stale one before it was locked
  }
  fail(EEXIST);
}

void TemporaryFile::take_rights_of(const struct stat& other) {
  mode_t mode = other.st_mode & 0777U;
  struct stat own{};
  if (::fstat(file_, &own) != 0) fail(errno);
  if (own.st_uid != other.st_uid || own.st_gid != other.st_gid) {
    if (::fchown(file_, other.st_uid, other.st_gid) != 0 &&
        ::fchown(file_, static_cast<uid_t>(-1), other.st_gid) != 0) {
      mode &= 0707U;
    }
  }
  // Some file systems know no modes.
  if (::fchmod(file_, mode) != 0 && errno != EPERM && errno != EOPNOTSUPP) fail(errno);
}

void TemporaryFile::write(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(file_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail(errno);
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

void TemporaryFile::publish() {
  if (::fsync(file_) != 0 && errno != EINVAL) fail(errno);
  const std::string descriptor = fmt::format("/proc/self/fd/{}", file_);
  for (int i = 0; name_.empty(); ++i) {
    const std::string name = new_name_for(target_);
    if (::linkat(AT_FDCWD, descriptor.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0) {
      name_ = name;
    } else if (errno != EEXIST || i == kAttempts) {
      fail(errno);
    }
  }
  if (std::rename(name_.c_str(), target_.c_str()) != 0) fail(errno);
  name_.clear();
  // Some file systems say only now that the disk is full, but then the write was synced before.
  ::close(std::exchange(file_, -1));
}

void remove_temporaries_in(const std::string& folder, const std::string& name) {
  const std::string prefix = name.empty() ? std::string() : prefix_of(name);
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    if (is_temporary_name(it->path().filename().string(), prefix)) {
      remove_unless_locked(it->path().string());
    }
  }
}

}  // namespace dxslam
