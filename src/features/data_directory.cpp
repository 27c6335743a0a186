// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "features/data_directory.h"

#include <dlfcn.h>
#include <link.h>

#include <cstdlib>
#include <filesystem>

namespace dxslam {
namespace {

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? std::string() : std::string(value);
}

// The file that this code was loaded from: the program, or the shared library in somebody else's.
std::filesystem::path own_file() {
  Dl_info symbol;
  link_map* object = nullptr;
  const void* here = reinterpret_cast<const void*>(&data_directory);
  const bool found =
      dladdr1(here, &symbol, reinterpret_cast<void**>(&object), RTLD_DL_LINKMAP) != 0 &&
      object != nullptr;
  // The program itself has no name there.
  const std::string name = found && object->l_name != nullptr ? object->l_name : "";
  std::error_code error;
  const auto file = std::filesystem::canonical(name.empty() ? "/proc/self/exe" : name, error);
  return error ? std::filesystem::path() : file;
}

// Beside the folder `bin`, `lib` or `lib/x86_64-linux-gnu`, wherever the tree was moved to.
std::string installed_data() {
  std::filesystem::path folder = own_file().parent_path();
  for (int up = 0; up < 2 && folder.has_relative_path(); ++up) {
    folder = folder.parent_path();
    const auto installed = folder / "share" / "dxslam";
    std::error_code error;
    if (std::filesystem::is_directory(installed, error)) return installed.string();
  }
  return "";
}

std::string& given_directory() {
  static std::string folder;
  return folder;
}

}  // namespace

void set_data_directory(const std::string& folder) { given_directory() = folder; }

std::string data_directory() {
  if (const std::string chosen = environment("DXSLAM_DATA"); !chosen.empty()) return chosen;
  if (!given_directory().empty()) return given_directory();
  if (const std::string installed = installed_data(); !installed.empty()) return installed;
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
