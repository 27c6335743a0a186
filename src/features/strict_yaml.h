// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <yaml-cpp/yaml.h>

#include <set>
#include <string>

#include "core/options.h"

namespace dxslam {

/// A YAML map of which every key must be asked for: finish() refuses the others, so that a
/// misspelt key is never silently ignored. Errors are InputErrors "FILE:LINE: ...".
class StrictMap {
 public:
  StrictMap(const YAML::Node& node, std::string file, std::string name);
  /// Parses a whole file; its top level must be a map.
  static StrictMap from_file(const std::string& path);

  bool has(const std::string& key) const;
  /// The value of a key that must be there.
  template <class T>
  T required(const std::string& key) {
    return convert<T>(get(key), key);
  }
  /// The value of a key, or `fallback` where it is absent.
  template <class T>
  T optional(const std::string& key, const T& fallback) {
    return has(key) ? convert<T>(get(key), key) : fallback;
  }
  StrictMap map(const std::string& key);
  /// Takes a key without looking into it.
  void ignore(const std::string& key) { asked_.insert(key); }
  /// Reads the options named by `describe` that are present, and checks their ranges.
  template <class Options>
  void read_options(Options& options) {
    Options::describe(options, *this);
    validate_options(name_, options);
  }
  void finish() const;
  [[noreturn]] void fail(const std::string& what) const;
  [[noreturn]] void fail_at(const std::string& key, const std::string& what) const;

  // The visitor that describe() wants.
  void operator()(const char* name, bool& value, const char*, const char*);
  void operator()(const char* name, std::string& value, const char*, const char*);
  template <class Number>
  void operator()(const char* name, Number& value, Range, const char*, const char*) {
    value = optional<Number>(name, value);
  }

 private:
  YAML::Node get(const std::string& key);
  [[noreturn]] void fail_at_line(int line, const std::string& what) const;
  template <class T>
  T convert(const YAML::Node& node, const std::string& key) const {
    try {
      return node.as<T>();
    } catch (const YAML::Exception&) {
      fail_conversion(node, key, expected_kind(static_cast<const T*>(nullptr)));
    }
  }
  [[noreturn]] void fail_conversion(const YAML::Node& node, const std::string& key,
                                    const char* expected) const;
  static const char* expected_kind(const bool*) { return "true or false"; }
  static const char* expected_kind(const int*) { return "an integer"; }
  static const char* expected_kind(const double*) { return "a number"; }
  static const char* expected_kind(const std::string*) { return "text"; }
  static const char* expected_kind(const void*) { return "a list of numbers"; }

  YAML::Node node_;
  std::string file_;
  std::string name_;  // of this map within the file, empty at the top
  std::set<std::string> asked_;
};

}  // namespace dxslam
