// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace dxslam {

/// A kind of file that this program writes, and how such a file is told from others.
struct FileKind {
  std::string name;  ///< with its article, e.g. "a map"; for sentences
  /// Whether a file is of this kind. Gets the first kFileHead bytes of it, or all if it is shorter;
  /// never none.
  std::function<bool(std::string_view head)> matches;
  std::vector<std::string> endings = {};  ///< of names, e.g. ".svg"; none: any name will do
};

constexpr std::size_t kFileHead = 4096;  // bytes

/// Files that begin with one of these texts.
FileKind kind_by_beginning(std::string name, std::vector<std::string> beginnings,
                           std::vector<std::string> endings = {});
/// JSON files as to_json_text() writes them: an object, or a list of such, whose first fields are
/// these; also an empty list.
FileKind json_kind(std::string name, std::vector<std::string> first_fields);

/// Throws InputError where a regular file is at `path` that is not of this kind, which a mistyped
/// name must not cost. Lets empty files through (`mktemp` makes them), and what is no regular file.
void require_kind_or_nothing(const std::string& path, const FileKind& kind);

/// The same, and throws InputError for a name of another ending, for missing folders and missing
/// permissions: where write_file_atomically() could not write. Changes nothing. To be called before
/// the work, for each file that a command writes.
void require_target(const std::string& path, const FileKind& kind);

/// The one path of the file that is written where `path` is asked for, be it there or not.
std::string canonical_target(const std::string& path);
/// Whether both paths lead to one file or folder, be it there or not. False for what is no regular
/// file nor folder (a terminal, /dev/null), which may be written to as often as one likes.
bool is_same_target(const std::string& a, const std::string& b);

}  // namespace dxslam
