// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace dxslam {

/// Whole file as bytes. Throws InputError if it is missing, is no regular file, cannot be read or
/// is larger than `max_bytes`; `expected` says what the file should have been, e.g. "a TUM list".
std::string read_file(const std::string& path, const std::string& expected,
                      std::size_t max_bytes = std::size_t{256} << 20);

/// One line with content: its number in the file (from 1) and its fields.
struct TextRow {
  int line = 0;
  std::vector<std::string> fields;
};

/// Rows of a table of blanks, tabs or commas. Blank lines, lines that start with '#', a byte-order
/// mark and carriage returns are dropped. Throws InputError as read_file does, and for binary data.
std::vector<TextRow> read_table(const std::string& path, const std::string& expected);
/// The same for text that is already in memory; `where` stands for the file in messages.
std::vector<TextRow> parse_table(std::string_view text, const std::string& where);

/// "FILE:LINE", as compilers write it.
std::string at_line(const std::string& path, int line);

/// The text in quotes, fit for an error message: cut to 60 characters, unprintable bytes as '?'.
std::string in_quotes(std::string_view text);

/// The number that `text` is, in full; nothing for anything else. NaN and infinities are numbers
/// here: callers that want finite ones ask for them.
std::optional<double> parse_number(std::string_view text);

/// Field `index` of a row as a finite number. Throws InputError naming file, line and field.
double finite_field(const std::string& path, const TextRow& row, std::size_t index,
                    const char* meaning);

/// The candidate closest to `word` by edit distance; empty if none is near (a third of its length).
std::string nearest_name(const std::string& word, const std::vector<std::string>& candidates);

}  // namespace dxslam
