// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "core/options.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace dxslam {
namespace {

struct InnerOptions {
  double gate = 2.0;
  double wide_gate = 4.0;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit("gate", self.gate, {0.5, 4.0}, "sigma", "a gate");
    visit(for_users("wide_gate"), self.wide_gate, {0.5, 9.0}, "sigma", "another");
  }
  template <class Checker>
  void relate(const Checker& check) const {
    check.at_most("gate", gate, "wide_gate", wide_gate);
  }
};

struct OuterOptions {
  int count = 3;
  bool fast = true;
  std::string name = "x";
  InnerOptions inner;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit("count", self.count, {1, 10}, "items", "how many");
    visit("fast", self.fast, "", "whether in a hurry");
    visit("name", self.name, "", "what it is called");
    visit.group("inner", self.inner);
  }
};

std::string refusal(const OuterOptions& options) {
  try {
    validate_options("outer", options);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Options, DefaultsAndBoundsAreValid) {
  OuterOptions options;
  EXPECT_EQ(refusal(options), "");
  options.count = 10;
  options.inner.gate = 0.5;
  EXPECT_EQ(refusal(options), "");
}

TEST(Options, NamesFieldValueUnitAndRange) {
  OuterOptions options;
  options.count = 0;
  EXPECT_EQ(refusal(options), "option outer.count is 0 items, expected 1 to 10");
}

TEST(Options, ChecksNestedGroups) {
  OuterOptions options;
  options.inner.gate = 4.5;
  EXPECT_THAT(refusal(options), testing::HasSubstr("outer.inner.gate is 4.5 sigma"));
}

TEST(Options, ChecksRelationsOfNestedGroups) {
  OuterOptions options;
  options.inner.wide_gate = options.inner.gate;
  EXPECT_EQ(refusal(options), "");
  options.inner.wide_gate = 1.5;
  EXPECT_EQ(refusal(options),
            "option outer.inner.gate is 2, expected at most outer.inner.wide_gate, which is 1.5");
}

TEST(Options, RefusesNan) {
  OuterOptions options;
  options.inner.gate = std::nan("");
  EXPECT_THAT(refusal(options), testing::HasSubstr("outer.inner.gate"));
}

}  // namespace
}  // namespace dxslam
