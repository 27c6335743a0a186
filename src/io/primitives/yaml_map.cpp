// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/primitives/yaml_map.h"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <unordered_map>

#include "core/error.h"
#include "io/primitives/text_file.h"
#include "io/primitives/yaml_text.h"

namespace dxslam {
namespace {

struct Entry {
  std::string key;
  int line = 0;
  YAML::Node value;
};

}  // namespace

struct YamlMap::State {
  std::string where;   // the file
  std::string prefix;  // names of the maps around this one, each with a dot behind
  int line = 1;
  std::vector<Entry> entries;
  std::unordered_map<std::string, std::size_t> places;  // of the entries, by key
  std::vector<std::string> asked;

  const Entry* find(const char* name) {
    asked.emplace_back(name);
    const auto found = places.find(name);
    return found == places.end() ? nullptr : &entries[found->second];
  }

  [[noreturn]] void fail(const Entry& entry, const std::string& expected) const {
    const std::string found = entry.value.IsScalar()     ? in_quotes(entry.value.Scalar())
                              : entry.value.IsMap()      ? "a mapping"
                              : entry.value.IsSequence() ? "a list"
                                                         : "empty";
    throw InputError(fmt::format("{}: {}{} is {}, expected {}", at_line(where, entry.line), prefix,
                                 entry.key, found, expected));
  }

  static std::unique_ptr<State> of(const YAML::Node& node, std::string where, std::string prefix,
                                   int line) {
    auto state = std::make_unique<State>();
    state->where = std::move(where);
    state->prefix = std::move(prefix);
    state->line = line;
    if (node.IsNull()) return state;
    for (const auto& pair : node) state->add(pair.first, pair.second);
    return state;
  }

  void add(const YAML::Node& key, const YAML::Node& value) {
    const int entry_line = yaml_line(key.Mark());
    if (!key.IsScalar()) {
      throw InputError(fmt::format("{}: a key that is no plain name", at_line(where, entry_line)));
    }
    const auto [place, is_new] = places.emplace(key.Scalar(), entries.size());
    if (!is_new) {
      throw InputError(fmt::format("{}: {}{} is given twice, first in line {}",
                                   at_line(where, entry_line), prefix, key.Scalar(),
                                   entries[place->second].line));
    }
    entries.push_back({key.Scalar(), entry_line, value});
  }
};

YamlMap::YamlMap(std::unique_ptr<State> state) : state_(std::move(state)) {}
YamlMap::YamlMap(YamlMap&&) noexcept = default;
YamlMap& YamlMap::operator=(YamlMap&&) noexcept = default;
YamlMap::~YamlMap() = default;

YamlMap YamlMap::parse(const std::string& text, const std::string& where) {
  const YAML::Node root = parse_yaml(text, where);
  if (!root.IsMap() && !root.IsNull()) {
    throw InputError(fmt::format("{}: expected 'name: value' lines", at_line(where, 1)));
  }
  return YamlMap(State::of(root, where, "", 1));
}

bool YamlMap::take(const char* name, bool& value) {
  const Entry* entry = state_->find(name);
  if (entry == nullptr) return false;
  const std::string text = entry->value.IsScalar() ? entry->value.Scalar() : "";
  if (text != "true" && text != "false") state_->fail(*entry, "true or false");
  value = text == "true";
  return true;
}

bool YamlMap::take(const char* name, std::string& value) {
  const Entry* entry = state_->find(name);
  if (entry == nullptr) return false;
  if (!entry->value.IsScalar() && !entry->value.IsNull()) state_->fail(*entry, "a text");
  value = entry->value.IsScalar() ? entry->value.Scalar() : "";
  return true;
}

bool YamlMap::take(const char* name, double& value, Range range, const char* unit) {
  const Entry* entry = state_->find(name);
  if (entry == nullptr) return false;
  const std::optional<double> number =
      parse_number(entry->value.IsScalar() ? entry->value.Scalar() : "");
  if (!number || !(*number >= range.min && *number <= range.max)) {
    state_->fail(*entry, fmt::format("a number from {} to {}{}{}", range.min, range.max,
                                     *unit == '\0' ? "" : " ", unit));
  }
  value = *number;
  return true;
}

bool YamlMap::take_integer(const char* name, long long& value, Range range, const char* unit) {
  const Entry* entry = state_->find(name);
  if (entry == nullptr) return false;
  const std::optional<double> number =
      parse_number(entry->value.IsScalar() ? entry->value.Scalar() : "");
  constexpr double kExact = 9007199254740992.0;  // 2^53: whole numbers up to here are exact
  if (!number || !(std::abs(*number) <= kExact) || *number != std::floor(*number) ||
      !(*number >= range.min && *number <= range.max)) {
    state_->fail(*entry, fmt::format("a whole number from {} to {}{}{}", range.min, range.max,
                                     *unit == '\0' ? "" : " ", unit));
  }
  value = static_cast<long long>(*number);
  return true;
}

bool YamlMap::take(const char* name, std::vector<double>& values) {
  const Entry* entry = state_->find(name);
  if (entry == nullptr) return false;
  if (!entry->value.IsSequence()) state_->fail(*entry, "a list of numbers");
  values.clear();
  for (const auto& item : entry->value) {
    const std::optional<double> number = parse_number(item.IsScalar() ? item.Scalar() : "");
    if (!number) state_->fail(*entry, "a list of numbers");
    values.push_back(*number);
  }
  return true;
}

std::optional<YamlMap> YamlMap::take_map(const char* name) {
  const Entry* entry = state_->find(name);
  if (entry == nullptr) return std::nullopt;
  if (!entry->value.IsMap() && !entry->value.IsNull()) state_->fail(*entry, "a mapping");
  return YamlMap(State::of(entry->value, state_->where, state_->prefix + name + ".", entry->line));
}

void YamlMap::finish() const {
  for (const Entry& entry : state_->entries) {
    bool known = false;
    for (const std::string& name : state_->asked) known = known || name == entry.key;
    if (known) continue;
    const std::string near = nearest_name(entry.key, state_->asked);
    throw InputError(fmt::format("{}: unknown key {}{}", at_line(state_->where, entry.line),
                                 in_quotes(state_->prefix + entry.key),
                                 near.empty() ? ", not one of this program"
                                              : ", did you mean '" + state_->prefix + near + "'?"));
  }
}

std::string YamlMap::where() const { return at_line(state_->where, state_->line); }

}  // namespace dxslam
