// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <string>
#include <type_traits>

#include "core/options.h"
#include "io/primitives/text_file.h"
#include "io/primitives/yaml_map.h"

namespace dxslam {

// Strict YAML for the options structs of core/options.h, made from their `describe`.

/// Visitor that fills the described fields from a map; used by the functions below.
class OptionsYamlReader {
 public:
  explicit OptionsYamlReader(YamlMap& map) : map_(map) {}

  void operator()(OptionName name, bool& value, const char*, const char*) {
    map_.take(name.text, value);
  }
  void operator()(OptionName name, std::string& value, const char*, const char*) {
    map_.take(name.text, value);
  }
  template <class Number>
  void operator()(OptionName name, Number& value, Range range, const char* unit, const char*) {
    if constexpr (std::is_integral_v<Number>) {
      long long whole = 0;
      if (map_.take_integer(name.text, whole, range, unit)) value = static_cast<Number>(whole);
    } else {
      double number = 0.0;
      if (map_.take(name.text, number, range, unit)) value = static_cast<Number>(number);
    }
  }
  template <class Options>
  void group(const char* name, Options& options) {
    auto nested = map_.take_map(name);
    if (!nested) return;
    OptionsYamlReader reader(*nested);
    Options::describe(options, reader);
    nested->finish();
  }

 private:
  YamlMap& map_;
};

/// Which options are written: those that users set, or the experts' as well.
enum class OptionsFor { kUsers, kExperts };

/// Visitor that writes each described field as "name: value  # meaning (unit, range)".
class OptionsYamlWriter {
 public:
  explicit OptionsYamlWriter(OptionsFor reader) : reader_(reader) {}

  void operator()(OptionName name, const bool& value, const char* unit, const char* meaning);
  void operator()(OptionName name, const std::string& value, const char* unit, const char* meaning);
  template <class Number>
  void operator()(OptionName name, const Number& value, Range range, const char* unit,
                  const char* meaning) {
    if constexpr (std::is_integral_v<Number>) {
      add_integer(name, static_cast<long long>(value), range, unit, meaning);
    } else {
      add_number(name, static_cast<double>(value), range, unit, meaning);
    }
  }
  template <class Options>
  void group(const char* name, const Options& options) {
    OptionsYamlWriter nested(reader_);
    nested.depth_ = depth_ + 1;
    Options::describe(options, nested);
    add_group(name, nested);
  }
  const std::string& text() const { return text_; }
  /// Options written, and left out.
  int written() const { return written_; }
  int left_out() const { return left_out_; }

 private:
  void add_group(const char* name, const OptionsYamlWriter& nested);
  void add_integer(OptionName name, long long value, Range range, const char* unit,
                   const char* meaning);
  void add_number(OptionName name, double value, Range range, const char* unit,
                  const char* meaning);
  void add_line(OptionName name, const std::string& value, const std::string& limits,
                const char* meaning);

  OptionsFor reader_;
  std::string text_;
  int depth_ = 0;
  int written_ = 0;
  int left_out_ = 0;
};

/// Overwrites the fields of `options` that `text` gives. Throws InputError naming file and line for
/// unknown or repeated keys, wrong types and values out of range; `options` may then be half read.
template <class Options>
void read_options_yaml(const std::string& text, const std::string& where, Options& options) {
  YamlMap map = YamlMap::parse(text, where);
  OptionsYamlReader reader(map);
  Options::describe(options, reader);
  map.finish();
}

/// The options of a YAML file over the defaults. Throws InputError as read_options_yaml does.
template <class Options>
Options load_options(const std::string& path, Options defaults = {}) {
  read_options_yaml(read_file(path, "a YAML configuration", limits::kYamlBytes), path, defaults);
  return defaults;
}

/// All fields with unit, range and meaning as comments; reading it back gives the same options.
template <class Options>
std::string dump_options_yaml(const Options& options) {
  OptionsYamlWriter writer(OptionsFor::kExperts);
  Options::describe(options, writer);
  return writer.text();
}

}  // namespace dxslam
