// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "evaluation/trajectory_svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/error.h"
#include "evaluation/svg.h"

namespace dxslam {
namespace {

// Pixels of the picture. The plot is at most kPlotWidth wide and kPlotHeight high.
constexpr double kPlotWidth = 860.0;
constexpr double kPlotHeight = 640.0;
constexpr double kLeast = 260.0;  // of either side of the plot
constexpr double kLeft = 64.0;
constexpr double kTop = 92.0;
constexpr double kRight = 24.0;
constexpr double kBottom = 60.0;
constexpr double kPadding = 24.0;   // between the outermost poses and the frame
constexpr double kGridStep = 90.0;  // wanted distance of grid lines
constexpr int kMostLines = 100;     // far from the origin, k + 1 may be k
constexpr double kLeastStep = 0.4;  // closer points are left out of a line
constexpr const char* kTruthColor = "#9aa1ab";
constexpr const char* kEstimateColor = "#1763c6";
constexpr const char* kStartColor = "#2a9d4a";
constexpr const char* kEndColor = "#d1372e";

struct View {
  int axis_x = 0;      // world axis drawn to the right
  int axis_y = 1;      // world axis drawn upwards
  double scale = 1.0;  // pixels per metre
  double x0 = 0.0;     // metres at the left edge of the plot
  double y1 = 0.0;     // metres at its top
  double width = 0.0;  // pixels of the plot
  double height = 0.0;

  double px(double metres) const { return kLeft + (metres - x0) * scale; }
  double py(double metres) const { return kTop + (y1 - metres) * scale; }
  Eigen::Vector2d at(const StampedPose& pose) const {
    const Eigen::Vector3d& p = pose.world_from_camera.translation();
    return {px(p[axis_x]), py(p[axis_y])};
  }
};

View fit_view(const Trajectory& estimate, const Trajectory& truth) {
  if (estimate.empty() && truth.empty()) return fit_view({StampedPose()}, {});  // around the origin
  Eigen::Vector3d low = Eigen::Vector3d::Constant(std::numeric_limits<double>::max());
  Eigen::Vector3d high = -low;
  for (const Trajectory* trajectory : {&estimate, &truth}) {
    for (const StampedPose& pose : *trajectory) {
      const Eigen::Vector3d& p = pose.world_from_camera.translation();
      require(p.allFinite(), "poses to draw must be finite");
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
  }
  const Eigen::Vector3d extent = high - low;
  int shortest = 0;
  extent.minCoeff(&shortest);
  View view;
  view.axis_x = shortest == 0 ? 1 : 0;
  view.axis_y = shortest == 2 ? 1 : 2;
  const double ex = std::max(extent[view.axis_x], 1e-3);
  const double ey = std::max(extent[view.axis_y], 1e-3);
  view.scale = std::min((kPlotWidth - 2 * kPadding) / ex, (kPlotHeight - 2 * kPadding) / ey);
  view.width = kPlotWidth;
  view.height = std::max(kLeast, ey * view.scale + 2 * kPadding);
  const double middle_x = 0.5 * (low[view.axis_x] + high[view.axis_x]);
  const double middle_y = 0.5 * (low[view.axis_y] + high[view.axis_y]);
  view.x0 = middle_x - 0.5 * view.width / view.scale;
  view.y1 = middle_y + 0.5 * view.height / view.scale;
  return view;
}

std::string draw_grid(const View& view) {
  std::string out =
      fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"#fbfcfd\"/>\n",
                  kLeft, kTop, view.width, view.height);
  const double step = round_length(kGridStep / view.scale) > 0.4 * kGridStep / view.scale
                          ? round_length(kGridStep / view.scale)
                          : 2.0 * round_length(kGridStep / view.scale);
  const int digits = std::max(0, static_cast<int>(-std::floor(std::log10(step) + 1e-9)));
  const double right = kLeft + view.width;
  const double bottom = kTop + view.height;
  constexpr const char* kLine = "stroke=\"#e3e7ec\" stroke-width=\"1\"";
  const auto first = [step](double metres) { return std::ceil(metres / step - 1e-9); };
  for (int i = 0; i < kMostLines; ++i) {
    const double k = first(view.x0) + i;
    const double x = view.px(k * step);
    if (!(x <= right + 0.01)) break;
    out += fmt::format("<path d=\"M{0:.1f} {1:.1f}V{2:.1f}\" {3}/>\n", x, kTop, bottom, kLine);
    out += svg_text(x, bottom + 18, fmt::format("{:.{}f}", k * step + 0.0, digits),
                    "class=\"tick\" text-anchor=\"middle\"");
  }
  for (int i = 0; i < kMostLines; ++i) {
    const double k = first(view.y1 - view.height / view.scale) + i;
    const double y = view.py(k * step);
    if (!(y >= kTop - 0.01)) break;
    out += fmt::format("<path d=\"M{0:.1f} {1:.1f}H{2:.1f}\" {3}/>\n", kLeft, y, right, kLine);
    out += svg_text(kLeft - 8, y + 4, fmt::format("{:.{}f}", k * step + 0.0, digits),
                    "class=\"tick\" text-anchor=\"end\"");
  }
  static constexpr char kAxes[] = "xyz";
  out += svg_text(right, bottom + 40, fmt::format("{} (m)", kAxes[view.axis_x]),
                  "class=\"label\" text-anchor=\"end\"");
  out += svg_text(12, kTop - 10, fmt::format("{} (m)", kAxes[view.axis_y]), "class=\"label\"");
  return out;
}

// Longest step between two poses that still belong together.
double longest_step(const Trajectory& trajectory) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    steps.push_back(trajectory[i].stamp - trajectory[i - 1].stamp);
  }
  if (steps.empty()) return 0.0;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return std::max(0.5, 10.0 * *middle);
}

std::string draw_line(const View& view, const Trajectory& trajectory, const char* color,
                      double width) {
  const double longest = longest_step(trajectory);
  std::string path;
  Eigen::Vector2d last(-1e9, -1e9);
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    const bool jump = i == 0 || trajectory[i].stamp - trajectory[i - 1].stamp > longest;
    const Eigen::Vector2d point = view.at(trajectory[i]);
    if (!jump && i + 1 < trajectory.size() && (point - last).norm() < kLeastStep) continue;
    path += fmt::format("{}{:.1f} {:.1f}", jump ? "M" : "L", point.x(), point.y());
    last = point;
  }
  return fmt::format(
      "<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" stroke-linejoin=\"round\" "
      "stroke-linecap=\"round\"/>\n",
      path, color, width);
}

std::string draw_scale_bar(const View& view) {
  const double metres = round_length(0.22 * view.width / view.scale);
  const double length = metres * view.scale;
  const double x = kLeft + 18;
  const double y = kTop + view.height - 18;
  const std::string label =
      metres >= 1.0 ? fmt::format("{:g} m", metres) : fmt::format("{:g} cm", 100.0 * metres);
  return fmt::format(
             "<path d=\"M{0:.1f} {2:.1f}v6H{1:.1f}v-6\" fill=\"none\" stroke=\"#2b3138\" "
             "stroke-width=\"2\"/>\n",
             x, x + length, y - 6) +
         svg_text(x + 0.5 * length, y - 10, label, "class=\"label halo\" text-anchor=\"middle\"");
}

std::string draw_legend(const View& view, bool with_truth) {
  std::string out;
  double x = kLeft + view.width - (with_truth ? 366 : 234);
  const double y = kTop - 14;
  const auto line = [&](const char* color, double width, const char* text, double advance) {
    out += fmt::format("<path d=\"M{:.1f} {:.1f}h26\" stroke=\"{}\" stroke-width=\"{}\"/>\n", x,
                       y - 4, color, width);
    out += svg_text(x + 33, y, text, "class=\"label\"");
    x += advance;
  };
  const auto mark = [&](const char* color, const char* text, double advance) {
    out += svg_dot(x + 6, y - 4, color);
    out += svg_text(x + 17, y, text, "class=\"label\"");
    x += advance;
  };
  if (with_truth) line(kTruthColor, 4, "ground truth", 132);
  line(kEstimateColor, 2, "estimate", 116);
  mark(kStartColor, "start", 74);
  mark(kEndColor, "end", 0);
  return out;
}

}  // namespace

std::string draw_trajectory_svg(const Trajectory& estimate, const Trajectory& truth,
                                const std::string& title, const std::string& subtitle) {
  const View view = fit_view(estimate, truth);
  const double width = kLeft + view.width + kRight;
  const double height = kTop + view.height + kBottom;
  std::string svg = svg_begin(width, height);
  svg += svg_text(kLeft, 34, svg_escaped(title), "class=\"title\"");
  svg += svg_text(kLeft, 56, svg_escaped(subtitle), "class=\"sub\"");
  svg += draw_grid(view);
  if (!truth.empty()) svg += draw_line(view, truth, kTruthColor, 4.0);
  if (estimate.empty()) {
    svg += svg_text(kLeft + 0.5 * view.width, kTop + 24, "no pose",
                    "class=\"label halo\" text-anchor=\"middle\"");
  } else {
    svg += draw_line(view, estimate, kEstimateColor, 2.0);
    const Eigen::Vector2d start = view.at(estimate.front());
    const Eigen::Vector2d end = view.at(estimate.back());
    svg += svg_dot(start.x(), start.y(), kStartColor);
    svg += svg_dot(end.x(), end.y(), kEndColor);
  }
  svg += draw_scale_bar(view);
  svg += draw_legend(view, !truth.empty());
  return svg + "</svg>\n";
}

}  // namespace dxslam
