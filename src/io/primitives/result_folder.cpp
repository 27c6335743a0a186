// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/primitives/result_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <fnmatch.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "core/error.h"
#include "io/primitives/atomic_file.h"

namespace dxslam {
namespace {

namespace fs = std::filesystem;

constexpr const char* kLock = ".dxslam.lock";
constexpr const char* kPrevious = "previous";
constexpr const char* kOnTheWay = ".dxslam-previous";  // becomes kPrevious when all is in it

bool matches(const std::string& name, const std::vector<std::string>& patterns) {
  return std::any_of(patterns.begin(), patterns.end(), [&](const std::string& pattern) {
    return ::fnmatch(pattern.c_str(), name.c_str(), FNM_PATHNAME) == 0;
  });
}

// Only of a regular file: opening a pipe would wait for somebody to write into it.
bool holds_more_than_comments(const fs::path& file) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return false;
  std::ifstream stream(file, std::ios::binary);
  for (std::string line; std::getline(stream, line);) {
    if (!line.empty() && line.front() != '#') return true;
  }
  return false;
}

bool same_file(int open_file, const std::string& path) {
  struct stat a{};
  struct stat b{};
  return ::fstat(open_file, &a) == 0 && ::stat(path.c_str(), &b) == 0 && a.st_dev == b.st_dev &&
         a.st_ino == b.st_ino;
}

[[noreturn]] void fail(const std::string& path, const std::string& reason) {
  throw InputError(
      fmt::format("{}: the results of the last run cannot be put aside: {}", path, reason));
}

void move_or_throw(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::rename(from, to, error);
  if (error) fail(from.string(), error.message());
}

void remove_or_throw(const fs::path& path) {
  std::error_code error;
  fs::remove(path, error);
  if (error) fail(path.string(), error.message());
}

}  // namespace

ResultFolder::ResultFolder(std::string folder, ResultFiles files)
    : folder_(std::move(folder)), files_(std::move(files)) {
  std::error_code error;
  made_ = !fs::exists(folder_, error);
  make_folder(folder_);
  lock();
  try {
    require_usable();
  } catch (...) {
    release();
    throw;
  }
}

void ResultFolder::require_usable() const {
  std::error_code error;
  for (fs::directory_iterator it(folder_, error), end; !error && it != end; it.increment(error)) {
    if (!matches(it->path().filename().string(), files_.all)) continue;
    const fs::file_status status = it->status(error);
    if (fs::is_regular_file(status) || !fs::exists(status)) continue;  // a link may lead nowhere
    throw InputError(fmt::format("{}: is no regular file, expected a result or nothing there",
                                 it->path().string()));
  }
  for (const char* name : {kPrevious, kOnTheWay}) {
    for (fs::directory_iterator it(file(name), error), end; !error && it != end;
         it.increment(error)) {
      if (matches(it->path().filename().string(), files_.all)) continue;
      throw InputError(
          fmt::format("{}: is no result, expected nothing but the last results in that folder",
                      it->path().string()));
    }
  }
}

bool ResultFolder::claims(const std::string& path) const {
  std::error_code error;
  const fs::path folder = fs::weakly_canonical(folder_, error);
  if (error) return false;
  const fs::path target = fs::weakly_canonical(path, error);
  if (error) return false;
  const std::string inside = target.lexically_relative(folder).string();
  for (const char* name : {kPrevious, kOnTheWay}) {
    if (inside == name || inside.starts_with(std::string(name) + "/")) return true;
  }
  return inside == kLock || matches(inside, files_.all);
}

ResultFolder::~ResultFolder() { release(); }

void ResultFolder::release() {
  ::unlink(file(kLock).c_str());  // before others can take it
  ::close(lock_);
  if (made_) ::rmdir(folder_.c_str());  // only if it is empty
}

std::string ResultFolder::file(const std::string& name) const {
  return (fs::path(folder_) / name).string();
}

// The last owner may have removed the file between opening and locking it here: then its lock means
// nothing.
void ResultFolder::lock() {
  const std::string path = file(kLock);
  do {
    if (lock_ >= 0) ::close(lock_);
    lock_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (lock_ < 0) {
      throw InputError(
          fmt::format("output folder {} cannot be written to: {}", folder_, std::strerror(errno)));
    }
    // A file system without locks is no reason to refuse the run.
    if (::flock(lock_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
      ::close(lock_);
      throw InputError(fmt::format(
          "output folder {} is in use by another run, expected a folder of its own for each",
          folder_));
    }
  } while (!same_file(lock_, path));
}

std::vector<std::string> ResultFolder::results_in(const std::string& folder) const {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    std::string name = it->path().filename().string();
    std::error_code ignored;
    if (matches(name, files_.all) && !it->is_directory(ignored)) names.push_back(std::move(name));
  }
  return names;
}

bool ResultFolder::has_content() const {
  const std::vector<std::string> names = results_in(folder_);
  return std::any_of(names.begin(), names.end(), [&](const std::string& name) {
    return matches(name, files_.content) && holds_more_than_comments(file(name));
  });
}

bool ResultFolder::whole() const {
  const std::vector<std::string> names = results_in(folder_);
  const auto is_last = [&](const std::string& name) { return matches(name, files_.last); };
  return std::any_of(names.begin(), names.end(), is_last) && has_content();
}

void ResultFolder::begin() {
  if (begun_) return;
  std::error_code error;
  const bool under_way = fs::exists(file(kOnTheWay), error);
  const bool kept = fs::exists(file(kPrevious), error) ? whole() : has_content();
  if (!under_way && !kept) {
    for (const std::string& name : results_in(folder_)) remove_or_throw(file(name));
  } else {
    move_aside();
  }
  begun_ = true;
}

void ResultFolder::move_aside() {
  const std::vector<std::string> names = results_in(folder_);
  std::error_code error;
  if (names.empty() && !fs::exists(file(kOnTheWay), error)) return;
  if (!fs::exists(file(kOnTheWay), error)) {
    fs::create_directory(file(kOnTheWay), error);
    if (error) fail(folder_, error.message());
  }
  for (const std::string& name : names) {
    move_or_throw(file(name), fs::path(file(kOnTheWay)) / name);
  }
  for (const std::string& name : results_in(file(kPrevious))) {
    remove_or_throw(fs::path(file(kPrevious)) / name);
  }
  move_or_throw(file(kOnTheWay), file(kPrevious));  // an empty folder there is replaced
}

void ResultFolder::finish() {
  if (!begun_ || !whole()) return;
  std::error_code error;
  for (const std::string& name : results_in(file(kPrevious))) {
    fs::remove(fs::path(file(kPrevious)) / name, error);
  }
  fs::remove(file(kPrevious), error);
}

}  // namespace dxslam
