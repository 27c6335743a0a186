// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "evaluation/openloris_svg.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"

namespace dxslam {
namespace {

using testing::HasSubstr;
using testing::Not;

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t i = text.find(part); i != std::string::npos; i = text.find(part, i + 1)) ++n;
  return n;
}

// One sequence from 0 to `end` with a pose each 0.1 s in [first, last), wrong from `wrong` on.
OpenlorisSequenceReport sequence(int number, double end, double first, double last, double wrong) {
  OpenlorisSequenceReport report;
  report.number = number;
  report.present = true;
  report.end = end;
  for (int i = 0; first + 0.1 * i < last - 1e-9; ++i) {
    const double stamp = first + 0.1 * i;
    report.errors.push_back({stamp, 0.0, 0.0, stamp < wrong - 1e-9});
    if (report.errors.back().correct) ++report.correct_position.count;
  }
  return report;
}

OpenlorisReport scene(const std::string& name, std::vector<OpenlorisSequenceReport> sequences) {
  OpenlorisReport report;
  report.scene = name;
  report.sequences = std::move(sequences);
  report.totals.correct_rate = 0.625;
  report.totals.correct_position = 0.0714;
  return report;
}

// Subpaths of the thick lines of a colour, the legend's left out.
std::size_t stretches(const std::string& svg, const std::string& color) {
  std::size_t n = 0;
  const std::string ending = "\" stroke=\"" + color + "\" stroke-width=\"5\"";
  for (std::size_t i = svg.find(ending); i != std::string::npos; i = svg.find(ending, i + 1)) {
    const std::size_t begin = svg.rfind("<path d=\"", i);
    n += count(svg.substr(begin, i - begin), "M");
  }
  return n - 1;
}

constexpr const char* kBlue = "#1763c6";
constexpr const char* kRed = "#d1372e";

TEST(OpenlorisSvg, ShowsWhenThePoseWasRightWrongOrUnknown) {
  OpenlorisSequenceReport lost = sequence(1, 60, 5, 20, 100);
  for (const auto& error : sequence(1, 60, 40, 50, 45).errors) lost.errors.push_back(error);
  const std::string svg =
      draw_openloris_svg({{"a <b>", {scene("home", {lost, sequence(2, 30, 3, 9, 0)})}}}, "Title");
  EXPECT_EQ(stretches(svg, kBlue), 2U);
  EXPECT_EQ(stretches(svg, kRed), 2U);
  EXPECT_THAT(svg, HasSubstr(">62.5 %<"));
  EXPECT_THAT(svg, HasSubstr(">0.071 m<"));
  EXPECT_THAT(svg, HasSubstr("a &lt;b&gt;"));
  EXPECT_THAT(svg, HasSubstr(">home<"));
  EXPECT_EQ(count(svg, "l9 9m0 -9l-9 9"), 2U);  // The second sequence begins wrong; legend.
  EXPECT_THAT(svg, testing::EndsWith("</svg>\n"));
}

TEST(OpenlorisSvg, PutsScenesSideBySideAndSystemsBelowEachOther) {
  const OpenlorisReport home = scene("home", {sequence(1, 60, 0, 60, 100)});
  const OpenlorisReport cafe = scene("cafe", {sequence(1, 20, 0, 0, 0)});
  const std::string svg =
      draw_openloris_svg({{"one", {home, cafe}}, {"two", {cafe}}, {"three", {home}}}, "Title");
  EXPECT_EQ(count(svg, ">home<"), 1U);
  EXPECT_EQ(count(svg, ">cafe<"), 1U);
  EXPECT_EQ(count(svg, ">62.5 %<"), 4U);
  EXPECT_EQ(count(svg, ">–<"), 2U);  // No correct pose, no error.
  EXPECT_EQ(stretches(svg, kBlue), 2U);
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
}

TEST(OpenlorisSvg, RefusesNothingAndDifferentTruths) {
  EXPECT_THROW(draw_openloris_svg({}, "Title"), ContractError);
  EXPECT_THROW(draw_openloris_svg({{"one", {}}}, "Title"), ContractError);
  EXPECT_THROW(draw_openloris_svg({{"one", {scene("home", {sequence(1, 60, 0, 60, 100)})}},
                                   {"two", {scene("home", {sequence(1, 61, 0, 60, 100)})}}},
                                  "Title"),
               ContractError);
}

}  // namespace
}  // namespace dxslam
