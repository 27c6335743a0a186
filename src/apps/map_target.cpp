// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "apps/map_target.h"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>
#include <utility>

#include "core/error.h"
#include "io/primitives/atomic_file.h"
#include "io/primitives/output_file.h"
#include "map_files/map_file.h"

namespace dxslam::apps {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPrevious = ".previous";
constexpr std::size_t kLongestBefore = 240;  // bytes of a name that has room for it

std::string previous_of(const std::string& target) {
  const std::string name = fs::path(target).filename().string().substr(0, kLongestBefore);
  return (fs::path(target).parent_path() / (name + kPrevious)).string();
}

}  // namespace

MapTarget::MapTarget(std::string path, const std::string& map_in)
    : path_(std::move(path)),
      target_(canonical_target(path_)),
      goes_on_(!map_in.empty() && is_same_target(path_, map_in)),
      lock_(lock_map_target(path_)) {
  if (lock_ == nullptr) return;
  previous_ = previous_of(target_);
  require_map_target(previous_);
}

void MapTarget::prepare() {
  if (previous_.empty()) return;
  std::error_code error;
  const fs::path folder = fs::path(target_).parent_path();
  if (!fs::exists(folder, error)) {
    make_folder(folder.string());
    lock_.reset();
    lock_ = lock_map_target(path_);
  }
  if (!prepared_ && !goes_on_) keep();
  prepared_ = true;
}

// By a second name, so that at no moment there is no map; not every file system has such.
void MapTarget::keep() const {
  std::error_code error;
  if (fs::exists(previous_, error) || !fs::exists(target_, error)) return;
  if (fs::file_size(target_, error) == 0) return;
  fs::create_hard_link(target_, previous_, error);
  if (error) fs::rename(target_, previous_, error);
  if (!error) return;
  throw InputError(fmt::format("{}: the map of before cannot be kept as {}: {}", path_, previous_,
                               error.message()));
}

void MapTarget::finish() {
  std::error_code error;
  if (prepared_) fs::remove(previous_, error);
}

std::string MapTarget::kept() const {
  std::error_code error;
  return prepared_ && !goes_on_ && fs::exists(previous_, error) ? previous_ : std::string();
}

}  // namespace dxslam::apps
