// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <string>
#include <string_view>

namespace dxslam {

/// Replaces `path` by a file of these bytes, or leaves it as it was: a temporary file in the same
/// folder is written, flushed to the disk and renamed. What is no regular file (a pipe, a terminal,
/// /dev/stdout) is written to as it is. Throws InputError with the reason (missing
/// folder, no permission, full disk).
void write_file_atomically(const std::string& path, std::string_view bytes);

/// Makes the folder and those above it. Throws InputError if that cannot be done.
void make_folder(const std::string& folder);

/// Removes the temporary files that processes of this machine left behind when they were killed
/// while write_file_atomically() wrote to `path`.
void remove_stale_temporaries(const std::string& path);

}  // namespace dxslam
