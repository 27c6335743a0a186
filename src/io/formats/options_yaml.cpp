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

void OptionsYamlWriter::add_group(const char* name, const OptionsYamlWriter& nested) {
  written_ += nested.written_;
  left_out_ += nested.left_out_;
  if (nested.written_ == 0) return;
  if (depth_ == 0 && !text_.empty()) text_ += '\n';
  text_ += fmt::format("{:{}}{}:\n{}", "", 2 * depth_, name, nested.text_);
}

void OptionsYamlWriter::operator()(OptionName name, const bool& value, const char* unit,
                                   const char* meaning) {
  add_line(name, value ? "true" : "false", unit, meaning);
}

void OptionsYamlWriter::operator()(OptionName name, const std::string& value, const char* unit,
                                   const char* meaning) {
  add_line(name, quote_yaml(value), unit, meaning);
}

void OptionsYamlWriter::add_integer(OptionName name, long long value, Range range, const char* unit,
                                    const char* meaning) {
  add_line(name, fmt::format("{}", value), limits_of(range, unit), meaning);
}

void OptionsYamlWriter::add_number(OptionName name, double value, Range range, const char* unit,
                                   const char* meaning) {
  add_line(name, fmt::format("{}", value), limits_of(range, unit), meaning);
}

void OptionsYamlWriter::add_line(OptionName name, const std::string& value,
                                 const std::string& limits, const char* meaning) {
  if (reader_ == OptionsFor::kUsers && !name.for_users) {
    ++left_out_;
    return;
  }
  ++written_;
  std::string line = fmt::format("{:{}}{}: {}", "", 2 * depth_, name.text, value);
  line.resize(std::max(line.size() + 2, kCommentColumn), ' ');
  text_ += fmt::format("{}# {}{}{}{}\n", line, meaning, limits.empty() ? "" : " (", limits,
                       limits.empty() ? "" : ")");
}

}  // namespace dxslam
