// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "features/data_directory.h"

#include <cstdlib>
#include <filesystem>

namespace dxslam {
namespace {

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? std::string() : std::string(value);
}

}  // namespace

std::string data_directory() {
  if (const std::string chosen = environment("DXSLAM_DATA"); !chosen.empty()) return chosen;
  std::error_code error;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", error);
  if (!error) {
    const auto installed = program.parent_path().parent_path() / "share" / "dxslam";
    if (std::filesystem::is_directory(installed, error)) return installed.string();
  }
  return DXSLAM_DATA_DIR;
}

bool is_data_directory_chosen() { return !environment("DXSLAM_DATA").empty(); }

std::string shared_directory() {
  if (const std::string chosen = environment("DXSLAM_SHARED"); !chosen.empty()) return chosen;
  return (std::filesystem::path(data_directory()) / ".." / "shared").lexically_normal().string();
}

std::string expand_variables(const std::string& path) {
  static const std::string kVariable = "${DXSLAM_SHARED}";
  const std::size_t at = path.find(kVariable);
  if (at == std::string::npos) return path;
  return path.substr(0, at) + shared_directory() + path.substr(at + kVariable.size());
}

std::string cache_directory() {
  if (const std::string cache = environment("XDG_CACHE_HOME"); !cache.empty()) {
    return cache + "/dxslam";
  }
  const std::string home = environment("HOME");
  return home.empty() ? std::string() : home + "/.cache/dxslam";
}

}  // namespace dxslam
