// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <string>
#include <string_view>

#include "vocabulary/vocabulary_tree.h"

namespace dxslam {

// The text format of DBoW2: a line "k L scoring weighting", then one line per node but the root,
// "parent is_leaf d0 d1 ... weight", numbered from 1; words are numbered in the order of their
// lines. Descriptors are bytes if those of the first node are integers of 0 to 255, else floats.

/// True if the text begins with a line as that of a file of DBoW2.
bool is_dbow2_text(std::string_view text);

/// Throws InputError with `where` and the line for anything else. Parents come before children.
VocabularyTree parse_dbow2_text(std::string_view text, const std::string& where);

/// The text of a tree that has passed check_tree(). Word ids stay as they are if they are distinct,
/// else words are numbered anew.
std::string format_dbow2_text(const VocabularyTree& tree);

}  // namespace dxslam
