// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <string_view>

namespace dxslam {

/// What to add to a refusal of a file that begins so: where a repository was cloned without Git
/// LFS, large files are small texts in their place. "" for all others.
constexpr std::string_view lfs_hint(std::string_view start) {
  return start.substr(0, 24) == "version https://git-lfs."
             ? "; it is only a pointer of Git LFS, `git lfs pull` fetches the file"
             : "";
}

}  // namespace dxslam
