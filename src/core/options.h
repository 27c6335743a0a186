// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstdint>
#include <string>

#include "core/error.h"

namespace dxslam {

// Options are plain structs with their defaults in the class. Each has one function
//
//   template <class Self, class Visitor>
//   static void describe(Self& self, Visitor& visit) {
//     visit("min_inliers", self.min_inliers, {1, 1000}, "matches", "what it decides");
//   }
//
// that names every field, its closed range, unit and meaning. Validation, strict reading from YAML
// and `dxslam config dump` all come from it, so a field cannot be forgotten in one of them.
// Fields are bool, int, double, std::string or another options struct (visit.group(name, field)).

/// Closed range of a numeric option.
struct Range {
  double min = 0.0;
  double max = 0.0;
};

/// Visitor that throws InputError for the first numeric field outside its range (NaN included).
class RangeChecker {
 public:
  explicit RangeChecker(std::string prefix) : prefix_(std::move(prefix)) {}

  void operator()(const char*, const bool&, const char*, const char*) {}
  void operator()(const char*, const std::string&, const char*, const char*) {}
  template <class Number>
  void operator()(const char* name, const Number& value, Range range, const char* unit,
                  const char*) {
    check(name, static_cast<double>(value), range, unit);
  }
  template <class Options>
  void group(const char* name, const Options& options) {
    RangeChecker nested(prefix_ + name + ".");
    Options::describe(options, nested);
  }

 private:
  void check(const char* name, double value, Range range, const char* unit) const;
  std::string prefix_;
};

/// Throws InputError naming field, value and bound, e.g.
/// "tracking.min_inliers is 0 matches, expected 1 to 1000".
template <class Options>
void validate_options(const std::string& name, const Options& options) {
  RangeChecker checker(name.empty() ? name : name + ".");
  Options::describe(options, checker);
}

}  // namespace dxslam
