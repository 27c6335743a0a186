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

  void operator()(const char* name, bool& value, const char*, const char*) {
    map_.take(name, value);
  }
  void operator()(const char* name, std::string& value, const char*, const char*) {
    map_.take(name, value);
  }
  template <class Number>
  void operator()(const char* name, Number& value, Range range, const char* unit, const char*) {
    if constexpr (std::is_integral_v<Number>) {
      long long whole = 0;
      if (map_.take_integer(name, whole, range, unit)) value = static_cast<Number>(whole);
    } else {
      double number = 0.0;
      if (map_.take(name, number, range, unit)) value = static_cast<Number>(number);
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

/// Visitor that writes each described field as "name: value  # meaning (unit, range)".
class OptionsYamlWriter {
 public:
  void operator()(const char* name, const bool& value, const char* unit, const char* meaning);
  void operator()(const char* name, const std::string& value, const char* unit,
                  const char* meaning);
  template <class Number>
  void operator()(const char* name, const Number& value, Range range, const char* unit,
                  const char* meaning) {
    if constexpr (std::is_integral_v<Number>) {
      add_integer(name, static_cast<long long>(value), range, unit, meaning);
    } else {
      add_number(name, static_cast<double>(value), range, unit, meaning);
    }
  }
  template <class Options>
  void group(const char* name, const Options& options) {
    open_group(name);
    Options::describe(options, *this);
    --depth_;
  }
  const std::string& text() const { return text_; }

 private:
  void open_group(const char* name);
  void add_integer(const char* name, long long value, Range range, const char* unit,
                   const char* meaning);
  void add_number(const char* name, double value, Range range, const char* unit,
                  const char* meaning);
  void add_line(const char* name, const std::string& value, const std::string& limits,
                const char* meaning);

  std::string text_;
  int depth_ = 0;
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
  OptionsYamlWriter writer;
  Options::describe(options, writer);
  return writer.text();
}

}  // namespace dxslam
