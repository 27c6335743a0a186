// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/primitives/name_order.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "io/primitives/text_file.h"

namespace dxslam {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kDigitsOfATime = 9;  // before the point: seconds since 1970
constexpr std::size_t kShownPatterns = 3;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

std::size_t digits_at(std::string_view text) {
  return static_cast<std::size_t>(std::find_if_not(text.begin(), text.end(), is_digit) -
                                  text.begin());
}

std::string_view without_zeros(std::string_view digits) {
  return digits.substr(std::min(digits.find_first_not_of('0'), digits.size()));
}

// Below, at or above 0, as the number a is less than, equal to or greater than b.
int compare_numbers(std::string_view a, std::string_view b) {
  a = without_zeros(a);
  b = without_zeros(b);
  if (a.size() != b.size()) return a.size() < b.size() ? -1 : 1;
  return a.compare(b);
}

// "whole.fraction" of digits; empty parts for any other name.
struct Decimal {
  std::string_view whole;
  std::string_view fraction;
};

Decimal as_decimal(std::string_view name) {
  const std::size_t point = name.find('.');
  if (point == std::string_view::npos || point == 0 || point + 1 == name.size()) return {};
  const Decimal decimal{name.substr(0, point), name.substr(point + 1)};
  const bool digits = digits_at(decimal.whole) == decimal.whole.size() &&
                      digits_at(decimal.fraction) == decimal.fraction.size();
  return digits ? decimal : Decimal{};
}

bool decimal_less(std::string_view a, std::string_view b) {
  const Decimal x = as_decimal(a);
  const Decimal y = as_decimal(b);
  const int whole = compare_numbers(x.whole, y.whole);
  if (whole != 0) return whole < 0;
  const int fraction = x.fraction.compare(y.fraction);
  return fraction != 0 ? fraction < 0 : a < b;
}

std::string stem_of(const fs::path& path) { return path.stem().string(); }

template <class Less>
void sort_stems(std::vector<fs::path>& files, const Less& less) {
  std::sort(files.begin(), files.end(), [&](const fs::path& a, const fs::path& b) {
    const std::string x = stem_of(a);
    const std::string y = stem_of(b);
    return x != y ? less(x, y) : a.filename() < b.filename();
  });
}

// Whether the names are decimal numbers, and whether these must be times.
struct DecimalNames {
  bool all = true;
  bool times = false;
};

DecimalNames decimal_names(const std::vector<fs::path>& files) {
  DecimalNames result;
  for (const fs::path& file : files) {
    const std::string stem = stem_of(file);
    const Decimal decimal = as_decimal(stem);
    if (decimal.whole.empty()) return {false, false};
    result.times = result.times || decimal.whole.size() >= kDigitsOfATime ||
                   (decimal.fraction.front() == '0' && decimal.fraction.size() > 1);
  }
  return result;
}

// The name with '#' for each number.
std::string pattern_of(const std::string& stem) {
  std::string pattern;
  for (const char c : stem) {
    if (!is_digit(c)) {
      pattern += c;
    } else if (pattern.empty() || pattern.back() != '#') {
      pattern += '#';
    }
  }
  return pattern;
}

std::string note_on_patterns(const std::vector<fs::path>& files) {
  std::set<std::string> patterns;
  for (const fs::path& file : files) patterns.insert(pattern_of(stem_of(file)));
  if (patterns.size() < 2) return {};
  std::vector<std::string> shown;
  for (const std::string& pattern : patterns) {
    if (shown.size() < kShownPatterns) shown.push_back(in_quotes(pattern));
  }
  return fmt::format(
      "image names of {} kinds ({}{}) are ordered by their letters first, then by their numbers",
      patterns.size(), fmt::join(shown, ", "), patterns.size() > shown.size() ? ", ..." : "");
}

}  // namespace

bool natural_less(std::string_view a, std::string_view b) {
  const std::string_view whole_a = a;
  const std::string_view whole_b = b;
  while (!a.empty() && !b.empty()) {
    if (is_digit(a.front()) && is_digit(b.front())) {
      const std::size_t m = digits_at(a);
      const std::size_t n = digits_at(b);
      const int order = compare_numbers(a.substr(0, m), b.substr(0, n));
      if (order != 0) return order < 0;
      a.remove_prefix(m);
      b.remove_prefix(n);
      continue;
    }
    if (a.front() != b.front()) {
      return static_cast<unsigned char>(a.front()) < static_cast<unsigned char>(b.front());
    }
    a.remove_prefix(1);
    b.remove_prefix(1);
  }
  if (a.empty() != b.empty()) return a.empty();
  return whole_a < whole_b;
}

std::vector<std::string> sort_by_name(std::vector<fs::path>& files) {
  sort_stems(files, natural_less);
  const DecimalNames decimals = decimal_names(files);
  if (files.size() < 2 || !decimals.all) {
    const std::string note = note_on_patterns(files);
    return note.empty() ? std::vector<std::string>{} : std::vector<std::string>{note};
  }
  std::vector<fs::path> by_value = files;
  sort_stems(by_value, decimal_less);
  if (by_value == files) return {};
  if (decimals.times) files = by_value;
  return {fmt::format(
      "image names such as {} are taken as {}", in_quotes(stem_of(files.front())),
      decimals.times ? "decimal numbers: 1.05 before 1.5" : "two numbers each: 1.9 before 1.10")};
}

}  // namespace dxslam
