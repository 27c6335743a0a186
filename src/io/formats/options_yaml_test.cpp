// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/formats/options_yaml.h"

#include "io/primitives/test_folder.h"

namespace dxslam {
namespace {

struct InnerOptions {
  int iterations = 5;
  double ratio = 0.75;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit("iterations", self.iterations, {1, 100}, "steps", "how many");
    visit(for_users("ratio"), self.ratio, {0, 1}, "", "how much");
  }
};

struct ExpertOptions {
  int steps = 5;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit("steps", self.steps, {1, 100}, "steps", "how many");
  }
};

struct OuterOptions {
  bool fast = true;
  std::string name = "a \"quoted\" \\ name\n";
  float radius = 0.1F;
  InnerOptions inner;
  ExpertOptions expert;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit(for_users("fast"), self.fast, "", "whether");
    visit("name", self.name, "", "who");
    visit("radius", self.radius, {0, 10}, "m", "how far");
    visit.group("inner", self.inner);
    visit.group("expert", self.expert);
  }
};

OuterOptions read(const std::string& text) {
  OuterOptions options;
  read_options_yaml(text, "c.yaml", options);
  return options;
}

TEST(OptionsYaml, ReadsWhatIsGivenAndKeepsTheRest) {
  const OuterOptions options = read("fast: false\ninner:\n  ratio: 0.5\n");
  EXPECT_FALSE(options.fast);
  EXPECT_EQ(options.inner.ratio, 0.5);
  EXPECT_EQ(options.inner.iterations, 5);
  EXPECT_EQ(read("").radius, 0.1F);
  EXPECT_EQ(read("# nothing\ninner:\n").inner.iterations, 5);
}

TEST(OptionsYaml, DumpReadsBackToTheSame) {
  OuterOptions options;
  options.radius = 1.0F / 3.0F;
  options.inner.ratio = 1e-9;
  const std::string text = dump_options_yaml(options);
  const OuterOptions again = read(text);
  EXPECT_EQ(again.radius, options.radius);
  EXPECT_EQ(again.inner.ratio, options.inner.ratio);
  EXPECT_EQ(again.name, options.name);
  EXPECT_EQ(dump_options_yaml(again), text);
  EXPECT_THAT(text, testing::HasSubstr("# how many (steps, 1 to 100)"));
}

TEST(OptionsYaml, UsersSeeTheirOptionsAlone) {
  const OuterOptions options;
  OptionsYamlWriter writer(OptionsFor::kUsers);
  OuterOptions::describe(options, writer);
  EXPECT_EQ(writer.text(),
            "fast: true                          # whether\n\n"
            "inner:\n"
            "  ratio: 0.75                       # how much (0 to 1)\n");
  EXPECT_EQ(writer.written(), 2);
  EXPECT_EQ(writer.left_out(), 4);
  EXPECT_EQ(read(writer.text()).inner.ratio, options.inner.ratio);
}

TEST(OptionsYaml, RefusesUnknownKeysWithTheNearestName) {
  expect_input_error([] { read("fast: true\ninner:\n  iteration: 3\n"); },
                     {"c.yaml:3", "inner.iteration", "did you mean 'inner.iterations'"});
  expect_input_error([] { read("zzz: 1\n"); }, {"c.yaml:1", "unknown key 'zzz'"});
}

TEST(OptionsYaml, RefusesRepeatedKeys) {
  expect_input_error([] { read("fast: true\nradius: 1\nfast: true\n"); },
                     {"c.yaml:3", "fast", "twice", "line 1"});
}

TEST(OptionsYaml, RefusesWrongTypesAndRanges) {
  expect_input_error([] { read("fast: 1\n"); }, {"c.yaml:1", "fast is '1'", "true or false"});
  expect_input_error([] { read("\nradius: far\n"); }, {"c.yaml:2", "'far'", "0 to 10 m"});
  expect_input_error([] { read("radius: .nan\n"); }, {"radius"});
  expect_input_error([] { read("radius: 11\n"); }, {"radius is '11'", "0 to 10"});
  expect_input_error([] { read("inner:\n  iterations: 2.5\n"); }, {"c.yaml:2", "whole number"});
  expect_input_error([] { read("inner: 3\n"); }, {"inner is '3'", "a mapping"});
  expect_input_error([] { read("name: [a]\n"); }, {"name is a list", "a text"});
  expect_input_error([] { read("- a\n- b\n"); }, {"c.yaml:1", "name: value"});
}

TEST(OptionsYaml, RefusesTextThatIsNoYaml) {
  expect_input_error([] { read("fast: [\n"); }, {"c.yaml:", "not valid YAML"});
  expect_input_error([] { read(std::string("\x00\x01\xff\xfe", 4)); }, {"c.yaml:"});
  expect_input_error([] { read(std::string(100000, '[')); }, {"c.yaml:"});
  expect_input_error([] { read("? [a, b]\n: 1\n"); }, {"no plain name"});
}

}  // namespace
}  // namespace dxslam
