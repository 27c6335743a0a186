// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "evaluation/svg.h"

#include <fmt/format.h>

#include <cmath>

#include "io/primitives/utf8.h"

namespace dxslam {

FileKind svg_kind() {
  return kind_by_beginning("an SVG picture of dxslam",
                           {"<svg xmlns=\"http://www.w3.org/2000/svg\" width=\""}, {".svg"});
}

std::string svg_begin(double width, double height) {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" "
      "viewBox=\"0 0 {0:.0f} {1:.0f}\">\n<style>text{{font-family:'Helvetica Neue',Arial,"
      "'DejaVu Sans',sans-serif;fill:#2b3138}}.title{{font-size:20px;font-weight:600}}"
      ".label{{font-size:14px}}.sub{{font-size:14px;fill:#5c6570}}"
      ".tick{{font-size:12px;fill:#7a838e}}.halo{{stroke:#fbfcfd;stroke-width:4px;"
      "paint-order:stroke}}</style>\n<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n",
      width, height);
}

std::string svg_text(double x, double y, const std::string& text, const std::string& attributes) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" {}>{}</text>\n", x, y, attributes, text);
}

std::string svg_escaped(const std::string& text) {
  std::string out;
  for (const char c : valid_utf8(text)) {
    if (c == '<') {
      out += "&lt;";
    } else if (c == '>') {
      out += "&gt;";
    } else if (c == '&') {
      out += "&amp;";
    } else {
      out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
  }
  return out;
}

std::string svg_dot(double x, double y, const std::string& color) {
  return fmt::format(
      "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"5.5\" fill=\"{}\" stroke=\"#ffffff\" "
      "stroke-width=\"2\"/>\n",
      x, y, color);
}

double round_length(double length) {
  const double power = std::pow(10.0, std::floor(std::log10(length)));
  const double digits = length / power;
  return power * (digits >= 5.0 ? 5.0 : digits >= 2.0 ? 2.0 : 1.0);
}

}  // namespace dxslam
