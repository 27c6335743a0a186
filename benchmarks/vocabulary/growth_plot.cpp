// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "growth_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "evaluation/svg.h"

namespace dxslam {
namespace {

constexpr double kWidth = 760.0;
constexpr double kHeight = 470.0;
constexpr double kLeft = 70.0;
constexpr double kRight = 730.0;
constexpr double kTop = 90.0;
constexpr double kBottom = 405.0;
constexpr const char* kColors[] = {"#1f5fbf", "#c0392b", "#2e8b57", "#8e44ad"};

// Pixels of the plot's corners, and what they stand for: both axes begin at 0.
struct Axes {
  double keyframes = 1.0;
  double ms = 1.0;

  double x(double k) const { return kLeft + (kRight - kLeft) * k / keyframes; }
  double y(double t) const { return kBottom - (kBottom - kTop) * t / ms; }
};

std::string draw_axes(const Axes& axes, double limit_ms) {
  std::string svg;
  const double step_ms = round_length(axes.ms / 4.0);
  for (double t = 0.0; t <= axes.ms; t += step_ms) {
    svg += fmt::format("<path d=\"M{} {:.1f}H{}\" stroke=\"#ddd\"/>\n", kLeft, axes.y(t), kRight);
    svg += svg_text(kLeft - 8, axes.y(t) + 4, fmt::format("{:g} ms", t),
                    "class=\"tick\" text-anchor=\"end\"");
  }
  const double step = round_length(axes.keyframes / 4.0);
  for (double k = 0.0; k <= axes.keyframes; k += step) {
    svg += svg_text(axes.x(k), kBottom + 20, fmt::format("{:g}", k),
                    "class=\"tick\" text-anchor=\"middle\"");
  }
  svg += svg_text((kLeft + kRight) / 2, kBottom + 44, "keyframes in the database",
                  "class=\"label\" text-anchor=\"middle\"");
  svg += fmt::format("<path d=\"M{0} {1:.1f}H{2}\" stroke=\"#555\" stroke-dasharray=\"2 4\"/>\n",
                     kLeft, axes.y(limit_ms), kRight);
  svg += svg_text(kRight, axes.y(limit_ms) - 6, fmt::format("limit {:g} ms", limit_ms),
                  "class=\"tick\" text-anchor=\"end\"");
  return svg;
}

std::string draw_line(const Axes& axes, const Growth& growth, double QueryTimes::* value,
                      const std::string& style) {
  std::string points;
  for (const QueryTimes& times : growth.sizes) {
    points += fmt::format("{:.1f},{:.1f} ", axes.x(static_cast<double>(times.keyframes)),
                          axes.y(times.*value));
  }
  return fmt::format("<polyline fill=\"none\" points=\"{}\" {}/>\n", points, style);
}

}  // namespace

std::string draw_growth_svg(const std::vector<Growth>& experiments, double limit_ms,
                            const std::string& title, const std::string& subtitle) {
  Axes axes;
  axes.ms = limit_ms * 1.1;
  for (const Growth& growth : experiments) {
    for (const QueryTimes& times : growth.sizes) {
      axes.keyframes = std::max(axes.keyframes, static_cast<double>(times.keyframes));
      axes.ms = std::max(axes.ms, times.p95_ms * 1.05);
    }
  }
  std::string svg = svg_begin(kWidth, kHeight);
  svg += svg_text(kLeft, 34, svg_escaped(title), "class=\"title\"");
  svg += svg_text(kLeft, 58, svg_escaped(subtitle), "class=\"sub\"");
  svg += draw_axes(axes, limit_ms);
  for (std::size_t i = 0; i < experiments.size(); ++i) {
    const std::string color = kColors[i % std::size(kColors)];
    const std::string stroke = fmt::format("stroke=\"{}\" stroke-width=\"2\"", color);
    svg += draw_line(axes, experiments[i], &QueryTimes::median_ms, stroke);
    svg += draw_line(axes, experiments[i], &QueryTimes::p95_ms,
                     stroke + " stroke-dasharray=\"6 5\" opacity=\"0.6\"");
    const double y = kTop + 52 + 20.0 * static_cast<double>(i);
    svg += svg_dot(kLeft + 20, y - 4, color);
    svg += svg_text(kLeft + 34, y, svg_escaped(experiments[i].label), "class=\"label\"");
  }
  return svg + "</svg>\n";
}

}  // namespace dxslam
