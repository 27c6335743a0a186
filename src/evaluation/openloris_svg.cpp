// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "evaluation/openloris_svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "evaluation/svg.h"

namespace dxslam {
namespace {

// Pixels of the picture.
constexpr double kLeft = 190.0;       // column of the names
constexpr double kPlotWidth = 960.0;  // all scenes with the gaps between them
constexpr double kSceneGap = 22.0;
constexpr double kRight = 24.0;
constexpr double kTop = 112.0;  // the line with the starts of the sequences
constexpr double kFirstRow = 52.0;
constexpr double kRowHeight = 54.0;
constexpr double kBottom = 62.0;
constexpr std::size_t kLongestName = 22;
constexpr const char* kCorrectColor = "#1763c6";
constexpr const char* kWrongColor = "#d1372e";
constexpr const char* kNothingColor = "#d5dae0";
constexpr const char* kInkColor = "#2b3138";

using Interval = std::pair<double, double>;  // pixels

// Where the sequences of a scene lie in the picture.
struct SceneColumn {
  const OpenlorisReport* sample = nullptr;  // any report about the scene
  double x = 0.0;
  double width = 0.0;
  std::vector<double> starts;  // pixels, one per sequence
};

struct Layout {
  std::vector<SceneColumn> columns;
  double scale = 0.0;  // pixels per second
};

const OpenlorisReport* report_of(const OpenlorisSystem& system, const std::string& scene) {
  for (const OpenlorisReport& report : system.scenes) {
    if (report.scene == scene) return &report;
  }
  return nullptr;
}

double duration(const OpenlorisReport& report) {
  double sum = 0.0;
  for (const OpenlorisSequenceReport& sequence : report.sequences) sum += sequence.duration();
  return sum;
}

void check_same_truth(const OpenlorisReport& a, const OpenlorisReport& b) {
  const bool same =
      std::equal(a.sequences.begin(), a.sequences.end(), b.sequences.begin(), b.sequences.end(),
                 [](const auto& x, const auto& y) {
                   return x.number == y.number && x.begin == y.begin && x.end == y.end;
                 });
  require(same, "reports of one scene must be about the same truth");
}

Layout lay_out(const std::vector<OpenlorisSystem>& systems) {
  Layout layout;
  double total = 0.0;
  for (const OpenlorisSystem& system : systems) {
    for (const OpenlorisReport& report : system.scenes) {
      const auto known = std::find_if(
          layout.columns.begin(), layout.columns.end(),
          [&](const SceneColumn& column) { return column.sample->scene == report.scene; });
      if (known != layout.columns.end()) {
        check_same_truth(*known->sample, report);
        continue;
      }
      layout.columns.push_back({&report, 0.0, 0.0, {}});
      total += duration(report);
    }
  }
  require(total > 0.0, "there is no scene to draw");
  const double gaps = kSceneGap * static_cast<double>(layout.columns.size() - 1);
  layout.scale = (kPlotWidth - gaps) / total;
  double x = kLeft;
  for (SceneColumn& column : layout.columns) {
    column.x = x;
    for (const OpenlorisSequenceReport& sequence : column.sample->sequences) {
      column.starts.push_back(x);
      x += sequence.duration() * layout.scale;
    }
    column.width = x - column.x;
    x += kSceneGap;
  }
  return layout;
}

// Times for which the poses stand that are correct, or wrong, joined where they touch.
std::vector<Interval> intervals(const OpenlorisSequenceReport& sequence, double longest,
                                double start, double scale, bool correct) {
  std::vector<Interval> joined;
  for (std::size_t i = 0; i < sequence.errors.size(); ++i) {
    const OpenlorisPoseError& error = sequence.errors[i];
    if (error.correct != correct) continue;
    const double next =
        i + 1 < sequence.errors.size() ? sequence.errors[i + 1].stamp : sequence.end;
    const double begin = error.stamp - sequence.begin;
    const double end = begin + std::min(next - error.stamp, longest);
    const Interval interval(start + begin * scale, start + end * scale);
    if (!joined.empty() && interval.first <= joined.back().second + 1e-6) {
      joined.back().second = interval.second;
    } else {
      joined.push_back(interval);
    }
  }
  return joined;
}

std::string draw_intervals(const std::vector<Interval>& list, double y, const char* color,
                           double width) {
  if (list.empty()) return {};
  std::string path;
  for (const auto& [begin, end] : list) path += fmt::format("M{:.1f} {:.1f}H{:.1f}", begin, y, end);
  return fmt::format("<path d=\"{}\" stroke=\"{}\" stroke-width=\"{}\"/>\n", path, color, width);
}

std::string draw_cross(double x, double y) {
  return fmt::format(
      "<path d=\"M{:.1f} {:.1f}l9 9m0 -9l-9 9\" stroke=\"{}\" stroke-width=\"2.5\"/>\n", x - 4.5,
      y - 4.5, kWrongColor);
}

std::string draw_scene_row(const OpenlorisReport& report, const SceneColumn& column, double scale,
                           double y) {
  std::string lines = draw_intervals({{column.x, column.x + column.width}}, y, kNothingColor, 2.0);
  std::string marks;
  for (std::size_t i = 0; i < report.sequences.size(); ++i) {
    const OpenlorisSequenceReport& sequence = report.sequences[i];
    const double longest = report.options.max_pose_interval;
    for (const bool correct : {false, true}) {
      lines += draw_intervals(intervals(sequence, longest, column.starts[i], scale, correct), y,
                              correct ? kCorrectColor : kWrongColor, 5.0);
    }
    if (sequence.errors.empty()) continue;
    const OpenlorisPoseError& first = sequence.errors.front();
    const double x = column.starts[i] + (first.stamp - sequence.begin) * scale;
    marks += first.correct ? svg_dot(x, y, kCorrectColor) : draw_cross(x, y);
  }
  const bool any_correct =
      std::any_of(report.sequences.begin(), report.sequences.end(),
                  [](const auto& sequence) { return sequence.correct_position.count > 0; });
  const std::string error =
      any_correct ? fmt::format("{:.3f} m", report.totals.correct_position) : std::string("–");
  return lines + marks +
         svg_text(column.x, y - 11, fmt::format("{:.1f} %", 100.0 * report.totals.correct_rate),
                  "class=\"tick\"") +
         svg_text(column.x + column.width, y + 20, error, "class=\"tick\" text-anchor=\"end\"");
}

std::string draw_header(const SceneColumn& column) {
  std::string out =
      draw_intervals({{column.x, column.x + column.width}}, kTop, kInkColor, 1.5) +
      svg_text(column.x + 0.5 * column.width, kTop - 26, svg_escaped(column.sample->scene),
               "class=\"label\" text-anchor=\"middle\"");
  for (std::size_t i = 0; i < column.starts.size(); ++i) {
    out += svg_dot(column.starts[i], kTop, kInkColor);
    out +=
        svg_text(column.starts[i], kTop - 10, fmt::format("{}", column.sample->sequences[i].number),
                 "class=\"tick\" text-anchor=\"middle\"");
  }
  return out;
}

std::string draw_footer(double scale, double y) {
  const double seconds = round_length(120.0 / scale);
  const double end = kLeft + kPlotWidth;
  const double begin = end - seconds * scale;
  std::string out = fmt::format(
                        "<path d=\"M{0:.1f} {2:.1f}v6H{1:.1f}v-6\" fill=\"none\" stroke=\"{3}\" "
                        "stroke-width=\"2\"/>\n",
                        begin, end, y - 10, kInkColor) +
                    svg_text(0.5 * (begin + end), y - 14, fmt::format("{:g} s", seconds),
                             "class=\"label\" text-anchor=\"middle\"");
  double x = kLeft;
  const auto line = [&](const char* color, double width, const char* text, double advance) {
    out += draw_intervals({{x, x + 26}}, y - 4, color, width);
    out += svg_text(x + 33, y, text, "class=\"label\"");
    x += advance;
  };
  line(kCorrectColor, 5.0, "correct", 100);
  line(kWrongColor, 5.0, "wrong", 92);
  line(kNothingColor, 2.0, "no pose", 108);
  out += svg_dot(x + 6, y - 4, kCorrectColor) + draw_cross(x + 22, y - 4) +
         svg_text(x + 36, y, "first pose of a sequence", "class=\"label\"");
  return out;
}

std::string shortened(const std::string& name) {
  return name.size() <= kLongestName ? name : name.substr(0, kLongestName - 1) + "…";
}

}  // namespace

std::string draw_openloris_svg(const std::vector<OpenlorisSystem>& systems,
                               const std::string& title, const std::string& subtitle) {
  const Layout layout = lay_out(systems);
  const double last_row = kTop + kFirstRow + kRowHeight * static_cast<double>(systems.size() - 1);
  const double height = last_row + kBottom + 24.0;
  std::string svg = svg_begin(kLeft + kPlotWidth + kRight, height);
  svg += svg_text(24, 34, svg_escaped(title), "class=\"title\"");
  svg += svg_text(24, 56, svg_escaped(subtitle), "class=\"sub\"");
  for (const SceneColumn& column : layout.columns) svg += draw_header(column);
  double y = kTop + kFirstRow;
  for (const OpenlorisSystem& system : systems) {
    svg += svg_text(kLeft - 18, y + 5, svg_escaped(shortened(system.name)),
                    "class=\"label\" text-anchor=\"end\"");
    for (const SceneColumn& column : layout.columns) {
      const OpenlorisReport* report = report_of(system, column.sample->scene);
      if (report != nullptr) svg += draw_scene_row(*report, column, layout.scale, y);
    }
    y += kRowHeight;
  }
  return svg + draw_footer(layout.scale, height - 24.0) + "</svg>\n";
}

}  // namespace dxslam
