// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/primitives/result_folder.h"

#include <fmt/format.h>
#include <fnmatch.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <system_error>

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
  try {
    lock_.emplace(file(kLock),
                  fmt::format("output folder {} is in use by another run, expected a folder of its "
                              "own for each",
                              folder_));
    require_usable();
  } catch (const std::system_error& e) {
    release();
    throw InputError(
        fmt::format("output folder {} cannot be written to: {}", folder_, e.code().message()));
  } catch (...) {
    release();
    throw;
  }
}

const ResultFile* ResultFolder::find(const std::string& name) const {
  const auto found = std::find_if(files_.all.begin(), files_.all.end(), [&](const auto& result) {
    return ::fnmatch(result.name.c_str(), name.c_str(), FNM_PATHNAME) == 0;
  });
  return found == files_.all.end() ? nullptr : &*found;
}

void ResultFolder::require_result(const std::string& path, const ResultFile& result) const {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) return;  // a link may lead nowhere
  if (!fs::is_regular_file(status)) {
    throw InputError(
        fmt::format("{}: is no regular file, expected a result or nothing there", path));
  }
  require_kind_or_nothing(path, result.kind);
}

void ResultFolder::require_usable() const {
  std::error_code error;
  for (fs::directory_iterator it(folder_, error), end; !error && it != end; it.increment(error)) {
    const ResultFile* const result = find(it->path().filename().string());
    if (result != nullptr) require_result(it->path().string(), *result);
  }
  for (const char* name : {kPrevious, kOnTheWay}) {
    const fs::file_status status = fs::symlink_status(file(name), error);
    if (fs::exists(status) && !fs::is_directory(status)) {
      throw InputError(fmt::format(
          "{}: is no folder, expected one for the last results or nothing there", file(name)));
    }
    for (fs::directory_iterator it(file(name), error), end; !error && it != end;
         it.increment(error)) {
      const std::string path = it->path().string();
      const ResultFile* const result = find(it->path().filename().string());
      if (result == nullptr) {
        throw InputError(fmt::format(
            "{}: is no result, expected nothing but the last results in that folder", path));
      }
      require_result(path, *result);
    }
  }
}

bool ResultFolder::claims(const std::string& path) const {
  std::error_code error;
  const fs::path folder = fs::weakly_canonical(fs::absolute(folder_, error), error);
  if (error) return false;
  const fs::path target = canonical_target(path);
  const std::string inside = target.lexically_relative(folder).string();
  for (const char* name : {kPrevious, kOnTheWay}) {
    if (inside == name || inside.starts_with(std::string(name) + "/")) return true;
  }
  return inside == "." || inside == kLock || find(inside) != nullptr;
}

ResultFolder::~ResultFolder() { release(); }

void ResultFolder::release() {
  lock_.reset();
  if (made_) ::rmdir(folder_.c_str());  // only if it is empty
}

std::string ResultFolder::file(const std::string& name) const {
  return (fs::path(folder_) / name).string();
}

std::vector<std::string> ResultFolder::results_in(const std::string& folder) const {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    std::string name = it->path().filename().string();
    std::error_code ignored;
    if (find(name) != nullptr && !it->is_directory(ignored)) names.push_back(std::move(name));
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
