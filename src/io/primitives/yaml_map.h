// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/options.h"

namespace dxslam {

/// A YAML mapping read strictly: every entry must be asked for by name, once, with its right type.
/// All failures are InputErrors that begin with "FILE:LINE". One thread at a time.
class YamlMap {
 public:
  /// Parses `text`; `where` names it in messages. An empty document is an empty map.
  static YamlMap parse(const std::string& text, const std::string& where);

  YamlMap(YamlMap&&) noexcept;
  YamlMap& operator=(YamlMap&&) noexcept;
  ~YamlMap();

  /// Reads entry `name` into `value`, which is left alone where the map has no such entry.
  /// Returns whether it had.
  bool take(const char* name, bool& value);
  bool take(const char* name, std::string& value);
  bool take(const char* name, double& value, Range range, const char* unit);
  /// For whole numbers of any width.
  bool take_integer(const char* name, long long& value, Range range, const char* unit);
  /// For a list of numbers.
  bool take(const char* name, std::vector<double>& values);
  /// Entry `name` as a map; nothing if there is none.
  std::optional<YamlMap> take_map(const char* name);

  /// Throws InputError for the first entry that nothing asked for, with the nearest name asked for.
  void finish() const;
  /// "FILE:LINE" of the map itself.
  std::string where() const;

 private:
  struct State;
  explicit YamlMap(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace dxslam
