// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <shared_mutex>
#include <string>
#include <string_view>

namespace dxslam {

/// Replaces `path` by a file of these bytes, or leaves it as it was: a temporary file in the same
/// folder is written, flushed to the disk and renamed. The new file has the mode of the old one,
/// and its owner where that is allowed. A link stays, what it points to is replaced. What is no
/// regular file (a pipe, a terminal, /dev/stdout) is written to as it is. Throws InputError with
/// the reason: missing folder, no permission, full disk, a pipe without a reader. Any thread.
void write_file_atomically(const std::string& path, std::string_view bytes);

/// The file that is replaced: `path`, or what this link leads to, also where that is missing.
std::string target_behind_links(const std::string& path);

/// Throws what write_file_atomically() would for missing folders and permissions. Changes nothing.
void require_writable(const std::string& path);

/// Makes the folder and those above it, and removes the temporary files that killed processes left
/// in it. Throws InputError if it cannot be made.
void make_folder(const std::string& folder);

/// Removes the temporary files that processes left behind when they were killed while
/// write_file_atomically() wrote to `path`.
void remove_stale_temporaries(const std::string& path);

/// Each write_file_atomically() to a regular file shares it while it lasts: who has it alone may
/// end the process.
std::shared_mutex& files_being_written();

/// From now on pipes whose readers do not read are an error at once.
void stop_waiting_for_readers();

}  // namespace dxslam
