// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/primitives/text_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>

#include "core/error.h"
#include "io/primitives/input_file.h"

namespace dxslam {
namespace {

constexpr std::string_view kBlanks = " \t";
constexpr std::string_view kSeparators = " \t,";
constexpr std::size_t kReadAtOnce = 1 << 16;

void split(std::string_view line, std::vector<std::string>& fields) {
  fields.clear();
  std::size_t begin = line.find_first_not_of(kSeparators);
  while (begin != std::string_view::npos) {
    const std::size_t end = std::min(line.find_first_of(kSeparators, begin), line.size());
    fields.emplace_back(line.substr(begin, end - begin));
    begin = line.find_first_not_of(kSeparators, end);
  }
}

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

// Whether the text is a number with a comma where its point should be.
bool is_comma_number(std::string_view text) {
  const std::size_t comma = text.find(',');
  if (comma == std::string_view::npos || comma == 0 || comma + 1 == text.size()) return false;
  std::string number(text);
  number[comma] = '.';
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  return is_digit(text[comma - 1]) && is_digit(text[comma + 1]) && parse_number(number).has_value();
}

// Makes rows of lines, one after the other.
class RowReader {
 public:
  RowReader(const std::string& where, const std::function<void(const TextRow&)>& take)
      : where_(where), take_(take) {}

  void operator()(std::string_view line) {
    if (++row_.line == 1) line = without_byte_order_mark(line);
    while (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    if (line.find('\r') != std::string_view::npos) {
      throw InputError(
          fmt::format("{}: carriage returns inside, expected lines that end with line feeds",
                      at_line(where_, row_.line)));
    }
    if (row_.line == 1 && (line.substr(0, 2) == "\xFF\xFE" || line.substr(0, 2) == "\xFE\xFF")) {
      throw InputError(fmt::format("{}: UTF-16 text, expected UTF-8", at_line(where_, row_.line)));
    }
    if (line.find('\0') != std::string_view::npos) {
      throw InputError(fmt::format("{}: binary data, expected text", at_line(where_, row_.line)));
    }
    line = trimmed(line);
    if (line.empty() || line.front() == '#') return;
    split(line, row_.fields);
    if (row_.fields.empty()) return;
    row_.text = line;
    take_(row_);
  }

 private:
  const std::string& where_;
  const std::function<void(const TextRow&)>& take_;
  TextRow row_;
};

[[noreturn]] void refuse_size(const std::string& path, std::uintmax_t size,
                              const std::string& expected, std::size_t max_bytes) {
  throw InputError(fmt::format("{}: {} bytes, expected {} of at most {} bytes", path, size,
                               expected, max_bytes));
}

void require_size(const InputFile& file, const std::string& path, const std::string& expected,
                  std::size_t max_bytes) {
  if (file.size() > max_bytes) refuse_size(path, file.size(), expected, max_bytes);
}

// Letters left out, added, replaced, or swapped with their neighbour.
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> two_up(b.size() + 1);
  std::vector<std::size_t> up(b.size() + 1);
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    two_up.swap(up);
    up.swap(row);
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t substitute = up[j] + (a[i] == b[j] ? 0 : 1);
      row[j + 1] = std::min({row[j] + 1, up[j + 1] + 1, substitute});
      const bool swapped = i > 0 && j > 0 && a[i] == b[j - 1] && a[i - 1] == b[j];
      if (swapped) row[j + 1] = std::min(row[j + 1], two_up[j - 1] + 1);
    }
  }
  return row.back();
}

}  // namespace

std::string read_file(const std::string& path, const std::string& expected, std::size_t max_bytes) {
  const InputFile file(path, expected);
  require_size(file, path, expected, max_bytes);
  std::string bytes(file.size(), '\0');
  if (file.read(bytes.data(), bytes.size()) < bytes.size()) {
    throw InputError(
        fmt::format("{}: became shorter while it was read, expected {}", path, expected));
  }
  return bytes;
}

std::string_view TextRow::rest(std::size_t index) const {
  std::string_view left = text;
  left.remove_prefix(std::min(left.find_first_not_of(kSeparators), left.size()));
  for (; index > 0 && !left.empty(); --index) {
    left.remove_prefix(std::min(left.find_first_of(kSeparators), left.size()));
    left.remove_prefix(std::min(left.find_first_not_of(kSeparators), left.size()));
  }
  return left;
}

void for_each_row(const std::string& path, const std::string& expected,
                  const std::function<void(const TextRow&)>& take) {
  const InputFile file(path, expected);
  require_size(file, path, expected, limits::kTextBytes);
  RowReader rows(path, take);
  std::vector<char> chunk(kReadAtOnce);
  std::string line;
  int number = 1;
  std::size_t total = 0;
  for (bool more = true; more;) {
    std::string_view text(chunk.data(), file.read(chunk.data(), chunk.size()));
    more = text.size() == chunk.size();
    total += text.size();
    if (total > limits::kTextBytes) refuse_size(path, total, expected, limits::kTextBytes);
    for (std::size_t end = text.find('\n'); end != std::string_view::npos; end = text.find('\n')) {
      line += text.substr(0, end);
      rows(line);
      line.clear();
      ++number;
      text.remove_prefix(end + 1);
    }
    line += text;
    if (line.size() > limits::kTextLineBytes) {
      throw InputError(fmt::format("{}: a line of more than {} bytes, expected {}",
                                   at_line(path, number), limits::kTextLineBytes, expected));
    }
  }
  rows(line);
}

std::vector<TextRow> parse_table(std::string_view text, const std::string& where) {
  std::vector<TextRow> rows;
  const std::function<void(const TextRow&)> keep = [&](const TextRow& row) { rows.push_back(row); };
  RowReader reader(where, keep);
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    reader(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return rows;
}

std::vector<TextRow> read_table(const std::string& path, const std::string& expected) {
  return parse_table(read_file(path, expected, limits::kSmallTextBytes), path);
}

void refuse_columns(const std::string& path, const TextRow& row, const std::string& expected) {
  const char* hint = "";
  if (has_decimal_commas(row.text)) {
    hint = "; its numbers have decimal commas, expected decimal points";
  } else if (row.text.find(';') != std::string::npos) {
    hint = "; its columns are parted by semicolons, expected blanks, tabs or commas";
  }
  throw InputError(fmt::format("{}: {} columns, expected {}{}", at_line(path, row.line),
                               row.fields.size(), expected, hint));
}

bool has_decimal_commas(std::string_view text) {
  constexpr std::string_view kParts = " \t;";
  bool found = false;
  std::size_t parts = 0;
  while (!text.empty()) {
    text.remove_prefix(std::min(text.find_first_not_of(kParts), text.size()));
    const std::size_t end = std::min(text.find_first_of(kParts), text.size());
    found = found || is_comma_number(text.substr(0, end));
    parts += end > 0 ? 1 : 0;
    text.remove_prefix(end);
  }
  return found && parts > 1;
}

std::string_view without_byte_order_mark(std::string_view text) {
  if (text.substr(0, 3) == "\xEF\xBB\xBF") text.remove_prefix(3);
  return text;
}

std::string at_line(const std::string& path, int line) { return fmt::format("{}:{}", path, line); }

std::string in_quotes(std::string_view text) {
  constexpr std::size_t kLongest = 60;
  std::string shown(text.substr(0, kLongest));
  for (char& c : shown) {
    if (c < ' ' || c > '~') c = '?';
  }
  return "'" + shown + (text.size() > kLongest ? "...'" : "'");
}

std::optional<double> parse_number(std::string_view text) {
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

double finite_field(const std::string& path, const TextRow& row, std::size_t index,
                    const char* meaning) {
  const std::string& text = row.fields.at(index);
  const std::optional<double> value = parse_number(text);
  if (value && std::isfinite(*value)) return *value;
  throw InputError(fmt::format("{}: {} is {}, expected a finite number", at_line(path, row.line),
                               meaning, in_quotes(text)));
}

std::string nearest_name(const std::string& word, const std::vector<std::string>& candidates) {
  if (word.size() > 100) return {};
  std::string best;
  std::size_t best_distance = std::max<std::size_t>(1, word.size() / 3) + 1;
  for (const std::string& candidate : candidates) {
    const std::size_t distance = edit_distance(word, candidate);
    if (distance < best_distance) {
      best = candidate;
      best_distance = distance;
    }
  }
  return best;
}

}  // namespace dxslam
