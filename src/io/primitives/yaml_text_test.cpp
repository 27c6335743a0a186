// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/primitives/yaml_text.h"

#include <fmt/format.h>

#include <chrono>

#include "io/primitives/limits.h"
#include "io/primitives/test_folder.h"
#include "io/primitives/yaml_map.h"

namespace dxslam {
namespace {

double seconds_to_refuse(const std::string& text, const std::vector<std::string>& parts) {
  const auto start = std::chrono::steady_clock::now();
  expect_input_error([&] { YamlMap::parse(text, "c.yaml"); }, parts);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::string keys(std::size_t count, const char* format) {
  std::string text;
  for (std::size_t i = 0; i < count; ++i) text += fmt::format(fmt::runtime(format), i);
  return text;
}

// A map of 200,000 keys took 38 seconds.
TEST(YamlText, RefusesHugeMapsAtOnce) {
  EXPECT_LT(seconds_to_refuse(keys(60000, "k{}: 1\n"), {"c.yaml:", "more than 10000 names"}), 5.0);
  EXPECT_LT(seconds_to_refuse("{" + keys(60000, "k{}: 1, ") + "}", {"more than 10000 names"}), 5.0);
  EXPECT_LT(seconds_to_refuse(keys(200000, "k{}: 1\n"), {"c.yaml: 2088890 bytes", "1048576"}), 5.0);
}

TEST(YamlText, RefusesDeepNestingAndManyAliases) {
  seconds_to_refuse("a: " + std::string(40, '[') + std::string(40, ']'), {"c.yaml:1", "33 deep"});
  std::string bomb = "a0: &a0 [x, x]\n";
  for (int i = 1; i < 40; ++i) bomb += fmt::format("a{}: &a{} [*a{}, *a{}]\n", i, i, i - 1, i - 1);
  EXPECT_NO_THROW(YamlMap::parse(bomb, "c.yaml"));  // built once each, and never unfolded
  seconds_to_refuse("a: &a 1\nb: [" + keys(20000, "*a, ") + "]\n", {"more than 10000 names"});
}

TEST(YamlText, RefusesASecondDocument) {
  EXPECT_NO_THROW(YamlMap::parse("---\na: 1\n...\n", "c.yaml"));
  seconds_to_refuse("a: 1\n---\nb: 1\n", {"c.yaml", "more than one YAML document"});
}

TEST(YamlText, ReadsWhatIsWithinTheLimits) {
  EXPECT_EQ(parse_yaml(keys(4000, "k{}: 1\n"), "c.yaml").size(), 4000U);
  expect_input_error([] { parse_yaml("a: [\n", "c.yaml"); }, {"c.yaml:2", "not valid YAML"});
}

}  // namespace
}  // namespace dxslam
