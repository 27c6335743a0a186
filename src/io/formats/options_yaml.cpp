// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/formats/options_yaml.h"

#include <fmt/format.h>

namespace dxslam {
namespace {

constexpr std::size_t kCommentColumn = 36;

std::string quote_yaml(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      out += fmt::format("\\{}", c);
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) {
      out += fmt::format("\\x{:02x}", static_cast<unsigned>(c));
    } else {
      out += c;
    }
  }
  return out + "\"";
}

std::string limits_of(Range range, const char* unit) {
  return fmt::format("{}{}{} to {}", unit, *unit == '\0' ? "" : ", ", range.min, range.max);
}

}  // namespace

void OptionsYamlWriter::open_group(const char* name) {
  if (depth_ == 0 && !text_.empty()) text_ += '\n';
  text_ += fmt::format("{:{}}{}:\n", "", 2 * depth_, name);
  ++depth_;
}

void OptionsYamlWriter::operator()(const char* name, const bool& value, const char* unit,
                                   const char* meaning) {
  add_line(name, value ? "true" : "false", unit, meaning);
}

void OptionsYamlWriter::operator()(const char* name, const std::string& value, const char* unit,
                                   const char* meaning) {
  add_line(name, quote_yaml(value), unit, meaning);
}

void OptionsYamlWriter::add_integer(const char* name, long long value, Range range,
                                    const char* unit, const char* meaning) {
  add_line(name, fmt::format("{}", value), limits_of(range, unit), meaning);
}

void OptionsYamlWriter::add_number(const char* name, double value, Range range, const char* unit,
                                   const char* meaning) {
  add_line(name, fmt::format("{}", value), limits_of(range, unit), meaning);
}

void OptionsYamlWriter::add_line(const char* name, const std::string& value,
                                 const std::string& limits, const char* meaning) {
  std::string line = fmt::format("{:{}}{}: {}", "", 2 * depth_, name, value);
  line.resize(std::max(line.size() + 2, kCommentColumn), ' ');
  text_ += fmt::format("{}# {}{}{}{}\n", line, meaning, limits.empty() ? "" : " (", limits,
                       limits.empty() ? "" : ")");
}

}  // namespace dxslam
