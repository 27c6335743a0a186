// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <string>
#include <string_view>

namespace dxslam {

/// `text` with every byte that is no part of a UTF-8 character replaced by U+FFFD. Names of files
/// are bytes; JSON and SVG files must be UTF-8.
std::string valid_utf8(std::string_view text);

/// `text` with the bytes of control characters, and those that are no part of a UTF-8 character, as
/// \xNN, a line end as \n: a file's name must not command the terminal that it is shown on.
std::string printable(std::string_view text);

}  // namespace dxslam
