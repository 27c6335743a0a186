// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/primitives/limits.h"

namespace dxslam {

/// Whole file as bytes. Throws InputError if it is missing, is no regular file, cannot be read or
/// is larger than `max_bytes`; `expected` says what the file should have been, e.g. "a TUM list".
std::string read_file(const std::string& path, const std::string& expected,
                      std::size_t max_bytes = limits::kFileBytes);

/// One line with content.
struct TextRow {
  int line = 0;                     ///< its number in the file, from 1
  std::vector<std::string> fields;  ///< what stands between blanks, tabs and commas
  std::string text;                 ///< the whole line, without blanks around it

  /// The text from field `index` on, blanks and commas inside it kept; empty beyond the last field.
  std::string_view rest(std::size_t index) const;
};

/// Reads a table of blanks, tabs or commas row by row: only one row is in memory at a time. Blank
/// lines, lines that start with '#', a byte-order mark and carriage returns are dropped. Throws
/// InputError as read_file does, for binary data, and beyond the limits of limits.h.
void for_each_row(const std::string& path, const std::string& expected,
                  const std::function<void(const TextRow&)>& take);
/// All rows of a small file (limits::kSmallTextBytes) at once.
std::vector<TextRow> read_table(const std::string& path, const std::string& expected);
/// The same for text that is already in memory; `where` stands for the file in messages.
std::vector<TextRow> parse_table(std::string_view text, const std::string& where);

/// Throws InputError "FILE:LINE: N columns, expected `expected`" and, where the row looks like it,
/// that its numbers have decimal commas.
[[noreturn]] void refuse_columns(const std::string& path, const TextRow& row,
                                 const std::string& expected);
/// Whether blanks part the columns and some number has a comma for its point, as in "0,5 1,25".
bool has_decimal_commas(std::string_view text);

/// The text without a UTF-8 byte-order mark at its beginning.
std::string_view without_byte_order_mark(std::string_view text);

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
