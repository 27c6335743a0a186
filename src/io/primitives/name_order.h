// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace dxslam {

/// The order in which people number things: runs of digits by value, all else byte by byte, so that
/// frame2 comes before frame10. A strict total order: names that differ by leading zeros only are
/// ordered byte by byte.
bool natural_less(std::string_view a, std::string_view b);

/// Sorts files by their names without the ending. If all names are decimal numbers ("12.5") that
/// are times (nine digits or more before the point, or zeros behind it, as in "12.05"), they are
/// ordered as such; else by natural_less. Returns one sentence for each choice that a user should
/// know of: such numbers where both orders differ, and names with different letters.
std::vector<std::string> sort_by_name(std::vector<std::filesystem::path>& files);

}  // namespace dxslam
