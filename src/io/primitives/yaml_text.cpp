// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/primitives/yaml_text.h"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "core/error.h"
#include "io/primitives/limits.h"
#include "io/primitives/text_file.h"

namespace dxslam {
namespace {

// Counts what a document holds and builds nothing.
class SizeCheck : public YAML::EventHandler {
 public:
  explicit SizeCheck(const std::string& where) : where_(where) {}

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t) override { count(mark); }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override { count(mark); }
  void OnScalar(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                const std::string&) override {
    count(mark);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {
    enter(mark);
  }
  void OnSequenceEnd() override { --depth_; }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {
    enter(mark);
  }
  void OnMapEnd() override { --depth_; }

 private:
  void count(const YAML::Mark& mark) {
    if (++nodes_ <= limits::kYamlNodes) return;
    throw InputError(fmt::format("{}: more than {} names and values, expected a smaller YAML file",
                                 at_line(where_, yaml_line(mark)), limits::kYamlNodes));
  }
  void enter(const YAML::Mark& mark) {
    count(mark);
    if (++depth_ <= limits::kYamlDepth) return;
    throw InputError(fmt::format("{}: lists and mappings inside each other, {} deep, expected less",
                                 at_line(where_, yaml_line(mark)), depth_));
  }

  const std::string& where_;
  std::size_t nodes_ = 0;
  std::size_t depth_ = 0;
};

void check_size(const std::string& text, const std::string& where) {
  if (text.size() > limits::kYamlBytes) {
    throw InputError(fmt::format("{}: {} bytes, expected YAML of at most {} bytes", where,
                                 text.size(), limits::kYamlBytes));
  }
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  SizeCheck check(where);
  parser.HandleNextDocument(check);
  if (parser.HandleNextDocument(check)) {
    throw InputError(fmt::format("{}: more than one YAML document, expected one", where));
  }
}

}  // namespace

YAML::Node yaml_child(const YAML::Node& node, const std::string& key) {
  if (!node.IsDefined() || !node.IsMap()) return YAML::Node(YAML::NodeType::Undefined);
  const YAML::Node value = node[key];
  return value ? value : YAML::Node(YAML::NodeType::Undefined);
}

std::string yaml_scalar(const YAML::Node& node) {
  return node.IsDefined() && node.IsScalar() ? node.Scalar() : std::string();
}

std::optional<std::vector<double>> finite_numbers(const YAML::Node& list) {
  if (!list.IsDefined() || !list.IsSequence()) return std::nullopt;
  std::vector<double> values;
  for (const YAML::Node& item : list) {
    const auto value = parse_number(yaml_scalar(item));
    if (!value || !std::isfinite(*value)) return std::nullopt;
    values.push_back(*value);
  }
  return values;
}

YAML::Node parse_opencv_yaml(const std::string& text, const std::string& where) {
  std::string plain(without_byte_order_mark(text));
  if (!plain.empty() && plain.front() == '%') {
    const std::size_t end = std::min(plain.find('\n'), plain.size());
    plain.replace(0, end, end, ' ');
  }
  return parse_yaml(plain, where);
}

int yaml_line(const YAML::Mark& mark) { return mark.line < 0 ? 1 : mark.line + 1; }

YAML::Node parse_yaml(const std::string& text, const std::string& where) {
  try {
    check_size(text, where);
    return YAML::Load(text);
  } catch (const YAML::Exception& e) {
    throw InputError(
        fmt::format("{}: not valid YAML: {}", at_line(where, yaml_line(e.mark)), e.msg));
  }
}

}  // namespace dxslam
