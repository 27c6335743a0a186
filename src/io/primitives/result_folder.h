// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/primitives/file_lock.h"
#include "io/primitives/output_file.h"

namespace dxslam {

/// Which files of a folder are results. Names are patterns as in a shell (`map_[0-9]*.txt`).
struct ResultFile {
  std::string name;
  FileKind kind;
};
struct ResultFiles {
  std::vector<ResultFile> all;
  /// One of these is written last: a folder that holds none has no whole results.
  std::vector<std::string> last;
  /// Text files, of which one must hold more than comments. Results without do not count as whole.
  std::vector<std::string> content;
  /// Folders in it that may hold results of the same names.
  std::vector<std::string> folders = {};
};

/// A folder into which one run at a time writes its results, which replace those of the run before
/// as a whole. Other files in it are left alone.
///
/// Nothing is touched before begin(). Then the last results move to the folder `previous`, where
/// they stay until a run ends well, which it says by finish(). A run that is killed, stopped or
/// fails thus leaves them whole, and never beside its own; the next one removes what it left and
/// keeps what is in `previous`. Results without content are not kept. One thread at a time.
class ResultFolder {
 public:
  /// Makes the folder, where it is missing, and takes it for this object; no other process gets it
  /// as long. Throws InputError, one sentence, if it cannot be made or written to, if another run
  /// writes into it, if something has the name of a result and is none (a file of another kind, a
  /// pipe, a folder), and if `previous` in it is no folder or holds other files.
  ResultFolder(std::string folder, ResultFiles files);
  ~ResultFolder();
  ResultFolder(const ResultFolder&) = delete;
  ResultFolder& operator=(const ResultFolder&) = delete;

  const std::string& path() const { return folder_; }
  /// The path of a file in it.
  std::string file(const std::string& name) const;
  /// Whether a file at `path` would be taken for one of the results, and so be replaced or removed.
  bool claims(const std::string& path) const;

  /// Puts the last results aside; once, further calls do nothing but make the folder again where
  /// somebody removed it. Throws InputError if that fails, and goes on where it stopped when it is
  /// called again.
  void begin();
  /// The run ended well: removes the last results, unless the new ones are not whole. Failures are
  /// passed over.
  void finish();
  /// Where the last results are that these did not replace; empty if there are none.
  std::string kept() const;

 private:
  void require_usable() const;
  void require_nothing_else(const std::string& folder, const std::string& within) const;
  const ResultFile* find(const std::string& name) const;
  void require_result(const std::string& path, const ResultFile& result) const;
  bool has_content() const;
  bool whole() const;
  std::vector<std::string> results_in(const std::string& folder) const;
  void remove_results_in(const std::string& folder) const;
  void make_again();
  void take();
  void move_aside();
  void release();

  std::string folder_;
  ResultFiles files_;
  std::optional<FileLock> lock_;
  bool made_ = false;  // the folder was not there
  bool begun_ = false;
};

}  // namespace dxslam
