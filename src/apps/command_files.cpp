// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "apps/command_files.h"

#include <fmt/format.h>

#include "core/error.h"

namespace dxslam::apps {

void CommandFiles::writes(const std::string& option, const std::string& path,
                          const FileKind& kind) {
  writes(option, path);
  if (!path.empty()) require_target(path, kind);
}

void CommandFiles::writes(const std::string& option, const std::string& path) {
  if (path.empty()) return;
  for (const std::string& input : inputs_) {
    if (input.empty() || !is_same_target(path, input)) continue;
    throw InputError(
        fmt::format("{} {}: is an input of this command, expected another name", option, path));
  }
  for (const Output& other : outputs_) {
    if (!is_same_target(path, other.path)) continue;
    throw InputError(fmt::format("{} {}: is the file of {}, too, expected another name", option,
                                 path, other.option));
  }
  outputs_.push_back({option, path});
}

}  // namespace dxslam::apps
