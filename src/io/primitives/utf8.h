// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <string>
#include <string_view>

namespace dxslam {

/// `text` with every byte that is no part of a UTF-8 character replaced by U+FFFD. Names of files
/// are bytes; JSON and SVG files must be UTF-8.
std::string valid_utf8(std::string_view text);

}  // namespace dxslam
