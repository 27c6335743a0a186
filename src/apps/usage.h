// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>

#include "core/error.h"
#include "core/options.h"

namespace dxslam::apps {

/// Visitor that finds the range of one number; groups within are passed over.
struct RangeFinder {
  const char* field;
  std::optional<Range> range;
  bool whole;

  void operator()(OptionName, const bool&, const char*, const char*) {}
  void operator()(OptionName, const std::string&, const char*, const char*) {}
  template <class Number>
  void operator()(OptionName name, const Number&, Range found, const char*, const char*) {
    if (std::string(name.text) != field) return;
    range = found;
    whole = std::is_integral_v<Number>;
  }
  template <class Options>
  void group(const char*, const Options&) {}
};

/// Checks of options: a whole number, or one that is finite, of a closed range.
CLI::Validator whole_number(std::int64_t min, std::int64_t max = 1'000'000'000);
CLI::Validator number(double min, double max);

/// The range of one field of described options (core/options.h). Throws ContractError if there is
/// no such number.
template <class Options>
CLI::Validator range_of(const char* field) {
  RangeFinder finder{field, std::nullopt, false};
  const Options defaults;
  Options::describe(defaults, finder);
  require(finder.range.has_value(), "no option of that name has a range");
  return finder.whole ? whole_number(static_cast<std::int64_t>(finder.range->min),
                                     static_cast<std::int64_t>(finder.range->max))
                      : number(finder.range->min, finder.range->max);
}

/// The gain of the low-light model, as an option.
CLI::Validator low_light_gain();

/// No option of the program takes an empty value: it is what an unset variable of a shell gives.
void refuse_empty_values(CLI::App& app);

/// Throws CLI::ParseError, naming the word and the nearest command, for a word that is no command
/// where one is due.
void require_known_commands(const CLI::App& app, int argc, const char* const* argv);

/// What help belongs to: "dxslam run" after that command was read.
std::string command_line_of(const CLI::App& app);

}  // namespace dxslam::apps
