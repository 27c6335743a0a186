// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include <fmt/format.h>

#include "evaluation/loop_curve.h"

namespace dxslam {
namespace {

// Pixels of the picture.
constexpr double kSide = 480.0;  // of the plot
constexpr double kLeft = 64.0;
constexpr double kTop = 72.0;
constexpr double kLegend = 300.0;
constexpr double kBottom = 56.0;
constexpr double kLeastStep = 0.2;  // closer points are left out of a line
constexpr const char* kColors[] = {"#1763c6", "#d1372e", "#2a9d4a", "#b06fd0",
                                   "#e08a1e", "#17a2b0", "#6b7280", "#c2398c"};

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '<') {
      out += "&lt;";
    } else if (c == '&') {
      out += "&amp;";
    } else {
      out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
  }
  return out;
}

double px(double recall) { return kLeft + recall * kSide; }
double py(double precision) { return kTop + (1.0 - precision) * kSide; }

std::string text_at(double x, double y, const std::string& text, const std::string& style = "") {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" {}>{}</text>\n", x, y, style, escaped(text));
}

std::string draw_axes() {
  std::string out;
  for (int tenth = 0; tenth <= 10; tenth += 2) {
    const double value = 0.1 * tenth;
    out +=
        fmt::format("<path d=\"M{:.1f} {:.1f}V{:.1f}M{:.1f} {:.1f}H{:.1f}\" stroke=\"#e3e7ec\"/>\n",
                    px(value), py(1), py(0), px(0), py(value), px(1));
    out += text_at(px(value), py(0) + 18, fmt::format("{:.1f}", value), "text-anchor=\"middle\"");
    out += text_at(px(0) - 8, py(value) + 4, fmt::format("{:.1f}", value), "text-anchor=\"end\"");
  }
  out += text_at(px(0.5), py(0) + 42, "recall", "text-anchor=\"middle\"");
  const double x = px(0) - 46;
  out += text_at(
      x, py(0.5), "precision",
      fmt::format("text-anchor=\"middle\" transform=\"rotate(-90 {:.1f} {:.1f})\"", x, py(0.5)));
  return out;
}

std::string draw_curve(const LoopCurve& curve, const char* color) {
  if (curve.points.empty() || curve.queries_with_loop == 0) return {};
  // From recall 0 at the precision of the surest guesses.
  double last_x = px(0.0);
  double last_y = py(curve.points.front().precision);
  std::string path = fmt::format("M{:.1f} {:.1f}", last_x, last_y);
  for (const PrecisionRecall& point : curve.points) {
    const double x = px(point.recall);
    const double y = py(point.precision);
    if (std::abs(x - last_x) + std::abs(y - last_y) < kLeastStep) continue;
    path += fmt::format("L{:.1f} {:.1f}", x, y);
    last_x = x;
    last_y = y;
  }
  return fmt::format(
      "<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\" stroke-linejoin=\"round\"/>\n"
      "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4\" fill=\"{}\"/>\n",
      path, color, px(curve.recall_at_100_precision), py(1.0), color);
}

}  // namespace

std::string draw_loop_curves_svg(const std::vector<NamedCurve>& curves, const std::string& title,
                                 const std::string& subtitle) {
  const double width = kLeft + kSide + kLegend;
  const double height = kTop + kSide + kBottom;
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" "
      "viewBox=\"0 0 {0:.0f} {1:.0f}\" font-family=\"sans-serif\" font-size=\"13\" "
      "fill=\"#1f2933\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
      width, height);
  out += text_at(kLeft, 30, title, "font-size=\"18\" font-weight=\"bold\"");
  out += text_at(kLeft, 52, subtitle, "fill=\"#5b6672\"");
  out += draw_axes();
  double y = kTop + 16;
  std::size_t next = 0;
  for (const NamedCurve& named : curves) {
    const char* color = kColors[next++ % std::size(kColors)];
    out += draw_curve(named.curve, color);
    const double x = kLeft + kSide + 24;
    out += fmt::format("<path d=\"M{:.1f} {:.1f}h22\" stroke=\"{}\" stroke-width=\"3\"/>\n", x,
                       y - 4, color);
    out += text_at(x + 30, y, named.name);
    const bool judged = named.curve.queries_with_loop > 0;
    out += text_at(
        x + 30, y + 16,
        judged ? fmt::format("recall {:.3f} at 100 % precision, AP {:.3f}",
                             named.curve.recall_at_100_precision, named.curve.average_precision)
               : "no true loop",
        "fill=\"#5b6672\" font-size=\"11\"");
    y += 42;
  }
  return out + "</svg>\n";
}

}  // namespace dxslam
