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
constexpr const char* kReplaced = ".dxslam-replaced";  // was kPrevious, is being removed

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
    take();
    require_usable();
  } catch (...) {
    release();
    throw;
  }
}

void ResultFolder::take() {
  lock_.reset();
  try {
    lock_.emplace(file(kLock),
                  fmt::format("output folder {} is in use by another run, expected a folder of its "
                              "own for each",
                              folder_));
  } catch (const std::system_error& e) {
    throw InputError(
        fmt::format("output folder {} cannot be written to: {}", folder_, e.code().message()));
  }
}

// `name` is relative to the folder.
const ResultFile* ResultFolder::find(const std::string& name) const {
  std::string leaf = name;
  for (const std::string& folder : files_.folders) {
    if (name.starts_with(folder + "/")) leaf = name.substr(folder.size() + 1);
  }
  const auto found = std::find_if(files_.all.begin(), files_.all.end(), [&](const auto& result) {
    return ::fnmatch(result.name.c_str(), leaf.c_str(), FNM_PATHNAME) == 0;
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

// Of a folder of last results, or, `within` it, of one in that.
void ResultFolder::require_nothing_else(const std::string& folder,
                                        const std::string& within) const {
  std::error_code error;
  for (fs::directory_iterator it(fs::path(folder) / within, error), end; !error && it != end;
       it.increment(error)) {
    const std::string name = (fs::path(within) / it->path().filename()).string();
    std::error_code ignored;
    if (std::count(files_.folders.begin(), files_.folders.end(), name) > 0 &&
        fs::is_directory(it->symlink_status(ignored))) {
      require_nothing_else(folder, name);
    } else if (find(name) == nullptr) {
      throw InputError(
          fmt::format("{}: is no result, expected nothing but the last results in that folder",
                      it->path().string()));
    }
  }
}

void ResultFolder::require_usable() const {
  for (const std::string& name : results_in(folder_)) require_result(file(name), *find(name));
  for (const char* name : {kPrevious, kOnTheWay, kReplaced}) {
    std::error_code error;
    const fs::file_status status = fs::symlink_status(file(name), error);
    if (fs::exists(status) && !fs::is_directory(status)) {
      throw InputError(fmt::format(
          "{}: is no folder, expected one for the last results or nothing there", file(name)));
    }
    require_nothing_else(file(name), "");
    for (const std::string& result : results_in(file(name))) {
      require_result((fs::path(file(name)) / result).string(), *find(result));
    }
  }
}

bool ResultFolder::claims(const std::string& path) const {
  std::error_code error;
  const fs::path folder = fs::weakly_canonical(fs::absolute(folder_, error), error);
  if (error) return false;
  const fs::path target = canonical_target(path);
  const std::string inside = target.lexically_relative(folder).string();
  for (const char* name : {kPrevious, kOnTheWay, kReplaced}) {
    if (inside == name || inside.starts_with(std::string(name) + "/")) return true;
  }
  if (std::count(files_.folders.begin(), files_.folders.end(), inside) > 0) return true;
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

// Whatever has the name of a result, relative to `folder`.
std::vector<std::string> ResultFolder::results_in(const std::string& folder) const {
  std::vector<std::string> names;
  std::vector<std::string> places = files_.folders;
  places.emplace_back();
  for (const std::string& place : places) {
    std::error_code error;
    for (fs::directory_iterator it(fs::path(folder) / place, error), end; !error && it != end;
         it.increment(error)) {
      std::string name = (fs::path(place) / it->path().filename()).string();
      if (find(name) != nullptr) names.push_back(std::move(name));
    }
  }
  return names;
}

void ResultFolder::remove_results_in(const std::string& folder) const {
  for (const std::string& name : results_in(folder)) {
    if (std::error_code error; fs::is_directory(fs::path(folder) / name, error)) continue;
    remove_or_throw(fs::path(folder) / name);
  }
  for (const std::string& name : files_.folders) ::rmdir((fs::path(folder) / name).c_str());
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

void ResultFolder::make_again() {
  std::error_code error;
  if (fs::exists(folder_, error)) return;
  make_folder(folder_);
  take();
}

void ResultFolder::begin() {
  make_again();
  if (begun_) return;
  std::error_code error;
  remove_results_in(file(kReplaced));
  fs::remove(file(kReplaced), error);
  const bool under_way = fs::exists(file(kOnTheWay), error);
  if (!under_way && (!kept().empty() || !has_content())) {
    remove_results_in(folder_);
  } else {
    move_aside();
  }
  begun_ = true;
}

void ResultFolder::move_aside() {
  std::error_code error;
  if (!fs::exists(file(kOnTheWay), error)) {
    fs::create_directory(file(kOnTheWay), error);
    if (error) fail(folder_, error.message());
  }
  for (const std::string& name : results_in(folder_)) {
    if (fs::is_directory(file(name), error)) continue;
    const fs::path target = fs::path(file(kOnTheWay)) / name;
    fs::create_directories(target.parent_path(), error);  // its failure is that of the move
    move_or_throw(file(name), target);
  }
  for (const std::string& name : files_.folders) ::rmdir(file(name).c_str());  // where it is empty
  remove_results_in(file(kPrevious));
  move_or_throw(file(kOnTheWay), file(kPrevious));  // an empty folder there is replaced
}

std::string ResultFolder::kept() const {
  return results_in(file(kPrevious)).empty() ? std::string() : file(kPrevious);
}

// By one step, after which they count no more: a kill in the middle must not leave a part of them.
void ResultFolder::finish() {
  if (!begun_ || !whole()) return;
  std::error_code error;
  fs::rename(file(kPrevious), file(kReplaced), error);
  if (error) return;
  try {
    remove_results_in(file(kReplaced));
  } catch (const InputError&) {  // the next run does it
  }
  fs::remove(file(kReplaced), error);
}

}  // namespace dxslam
