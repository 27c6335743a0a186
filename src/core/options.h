// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>

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
// A field that users set is visited as `for_users("min_inliers")`; the rest are for experts.
//
// What must hold between fields stands in a second function, if there is any such thing:
//
//   template <class Checker>
//   void relate(const Checker& check) const {
//     check.at_most("narrow_radius", narrow_radius, "wide_radius", wide_radius);
//   }

/// The name of an option, and whom it is for.
struct OptionName {
  OptionName(const char* name) : text(name) {}  // NOLINT(google-explicit-constructor)

  const char* text;
  bool for_users = false;
};

inline OptionName for_users(const char* name) {
  OptionName option(name);
  option.for_users = true;
  return option;
}

/// Closed range of a numeric option.
struct Range {
  double min = 0.0;
  double max = 0.0;
};

/// Visitor that throws InputError for the first numeric field outside its range (NaN included), and
/// for the first relation between fields that does not hold.
class RangeChecker {
 public:
  explicit RangeChecker(std::string prefix) : prefix_(std::move(prefix)) {}

  void operator()(OptionName, const bool&, const char*, const char*) {}
  void operator()(OptionName, const std::string&, const char*, const char*) {}
  template <class Number>
  void operator()(OptionName name, const Number& value, Range range, const char* unit,
                  const char*) {
    check(name.text, static_cast<double>(value), range, unit);
  }
  template <class Options>
  void group(const char* name, const Options& options) {
    RangeChecker(prefix_ + name + ".").check_all(options);
  }

  template <class Options>
  void check_all(const Options& options) {
    Options::describe(options, *this);
    if constexpr (HasRelations<Options>::value) options.relate(*this);
  }
  /// For `relate`: throws unless value <= bound.
  void at_most(const char* name, double value, const char* bound_name, double bound) const;

 private:
  template <class Options, class = void>
  struct HasRelations : std::false_type {};
  template <class Options>
  struct HasRelations<Options, std::void_t<decltype(std::declval<const Options&>().relate(
                                   std::declval<const RangeChecker&>()))>> : std::true_type {};

  void check(const char* name, double value, Range range, const char* unit) const;
  std::string prefix_;
};

/// Throws InputError naming field, value and bound, e.g. "option tracking.min_inliers is 0 matches,
/// expected 1 to 1000" or "option a.narrow is 3, expected at most a.wide, which is 2".
template <class Options>
void validate_options(const std::string& name, const Options& options) {
  RangeChecker(name.empty() ? name : name + ".").check_all(options);
}

}  // namespace dxslam
