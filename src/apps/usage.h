// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

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

/// One of these words.
CLI::Validator one_of(std::vector<std::string> words);
/// What `take` takes without an InputError, whose sentence is shown otherwise.
CLI::Validator accepted_by(std::function<void(const std::string&)> take);
/// A file for a picture, which is written as SVG whatever its name says.
CLI::Validator svg_file();
/// auto, or a format of recordings.
CLI::Validator recording_format();
/// Of the arithmetic of networks.
CLI::Validator precision_name();
/// The name of an extractor, or a manifest (*.yaml).
CLI::Validator extractor_name();

/// The gain of the low-light model, as an option.
CLI::Validator low_light_gain();

/// An option that the others leave without use is a mistake: throws InputError if `option` is given
/// but not `used`. `meant`: with what it would be, e.g. "with --map-out".
void refuse_unused(const CLI::App& command, const char* option, bool used, const char* meant);

/// No option of the program takes an empty value: it is what an unset variable of a shell gives.
void refuse_empty_values(CLI::App& app);

/// Throws CLI::ParseError, naming the word and the nearest that is known, for a word that is no
/// command where one is due, and for an option that is followed by "=" and nothing.
void require_known_words(const CLI::App& app, int argc, const char* const* argv);

/// What is wrong with the command line after `app` did not take it, and which help tells more.
std::string usage_problem(const CLI::App& app, int argc, const char* const* argv,
                          const CLI::ParseError& error);

}  // namespace dxslam::apps
