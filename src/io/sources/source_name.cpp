// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/error.h"
#include "io/primitives/text_file.h"
#include "io/sources/live_camera.h"

namespace dxslam {
namespace {

std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  while (begin <= text.size()) {
    const std::size_t end = std::min(text.find(at, begin), text.size());
    if (end > begin) parts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

}  // namespace

SourceName::SourceName(const std::string& text) : text_(text) {
  const std::size_t colon = text.find(':');
  require(colon != std::string::npos, "the name of a live source begins with its kind");
  const std::size_t question = std::min(text.find('?', colon), text.size());
  kind_ = text.substr(0, colon);
  places_ = split(text.substr(colon + 1, question - colon - 1), ',');
  if (question == text.size()) return;
  for (const std::string& option : split(text.substr(question + 1), '&')) {
    const std::size_t equals = option.find('=');
    if (equals == 0 || equals == std::string::npos || equals + 1 == option.size()) {
      throw InputError(fmt::format("{}: {} is no option, expected NAME=VALUE", in_quotes(text),
                                   in_quotes(option)));
    }
    options_.emplace_back(option.substr(0, equals), option.substr(equals + 1));
  }
}

void SourceName::require_options(const std::vector<std::string>& known) const {
  for (const auto& [name, text] : options_) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    throw InputError(fmt::format("{}: no option {}, expected one of {}", in_quotes(text_),
                                 in_quotes(name), fmt::join(known, ", ")));
  }
}

std::optional<std::string> SourceName::value(const std::string& option) const {
  for (const auto& [name, text] : options_) {
    if (name == option) return text;
  }
  return std::nullopt;
}

std::optional<double> SourceName::number(const std::string& option, double min, double max) const {
  const std::optional<std::string> text = value(option);
  if (!text) return std::nullopt;
  const std::optional<double> number = parse_number(*text);
  if (number && *number >= min && *number <= max) return number;
  throw InputError(fmt::format("{}: {} is {}, expected a number from {:g} to {:g}",
                               in_quotes(text_), option, in_quotes(*text), min, max));
}

}  // namespace dxslam
