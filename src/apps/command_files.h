// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <string>
#include <vector>

#include "io/primitives/output_file.h"

namespace dxslam::apps {

/// The files that a command reads and writes, noted before it works: what it writes replaces none
/// of what it reads, nor another of its own files, nor a file of another kind.
class CommandFiles {
 public:
  /// `inputs` are files and folders; empty ones are none.
  explicit CommandFiles(std::vector<std::string> inputs) : inputs_(std::move(inputs)) {}

  /// Notes what `option` is given as. Throws InputError, one sentence, if that must not or cannot
  /// be written. Does nothing for an empty path.
  void writes(const std::string& option, const std::string& path, const FileKind& kind);
  /// The same for a file whose kind is looked at elsewhere.
  void writes(const std::string& option, const std::string& path);

 private:
  struct Output {
    std::string option;
    std::string path;
  };

  std::vector<std::string> inputs_;
  std::vector<Output> outputs_;
};

}  // namespace dxslam::apps
