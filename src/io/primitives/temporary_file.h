// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <sys/stat.h>

#include <string>
#include <string_view>

namespace dxslam {

/// A new file that takes the place of `target` when it is whole. Until then it has no name, or,
/// where the file system knows only files with names, one that nobody can guess, and it is locked,
/// so that others see that it is in use. All throw std::system_error. One thread at a time.
class TemporaryFile {
 public:
  enum class Kind { kAny, kNamed };

  explicit TemporaryFile(const std::string& target, Kind kind = Kind::kAny);
  ~TemporaryFile();  ///< what was not published is gone
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  /// Mode, and owner and group as far as allowed; where the group is not, it gets no rights.
  void take_rights_of(const struct stat& other);
  /// Appends.
  void write(std::string_view bytes);
  /// Flushes to the disk and replaces `target`.
  void publish();

 private:
  bool make_unnamed();
  void make_named();

  std::string target_;
  std::string name_;  // empty while it has none
  int file_ = -1;
};

/// Removes the files that killed processes left in `folder` on the way to a file called `name`; to
/// any file where that is empty. Failures are passed over.
void remove_temporaries_in(const std::string& folder, const std::string& name);

}  // namespace dxslam
