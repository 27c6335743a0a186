// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "features/strict_yaml.h"

#include <fmt/format.h>

#include "core/error.h"

namespace dxslam {

StrictMap::StrictMap(const YAML::Node& node, std::string file, std::string name)
    : node_(node), file_(std::move(file)), name_(std::move(name)) {
  if (!node_.IsMap()) {
    fail(fmt::format("found something else than a map, expected `key: value` lines{}",
                     name_.empty() ? "" : " under " + name_));
  }
}

StrictMap StrictMap::from_file(const std::string& path) {
  try {
    return {YAML::LoadFile(path), path, ""};
  } catch (const YAML::BadFile&) {
    throw InputError(fmt::format("{}: cannot be opened, expected a YAML file", path));
  } catch (const YAML::ParserException& e) {
    throw InputError(fmt::format("{}:{}: not valid YAML: {}", path, e.mark.line + 1, e.msg));
  }
}

bool StrictMap::has(const std::string& key) const { return static_cast<bool>(node_[key]); }

YAML::Node StrictMap::get(const std::string& key) {
  asked_.insert(key);
  const YAML::Node value = node_[key];
  if (!value) fail(fmt::format("{} is missing", name_.empty() ? key : name_ + "." + key));
  return value;
}

StrictMap StrictMap::map(const std::string& key) {
  return {get(key), file_, name_.empty() ? key : name_ + "." + key};
}

void StrictMap::finish() const {
  for (const auto& entry : node_) {
    const auto key = entry.first.as<std::string>();
    if (asked_.count(key) != 0) continue;
    std::string known;
    for (const std::string& name : asked_) known += (known.empty() ? "" : ", ") + name;
    fail_at_line(entry.first.Mark().line,
                 fmt::format("unknown key `{}`{}, expected one of: {}", key,
                             name_.empty() ? "" : " in " + name_, known));
  }
}

void StrictMap::fail(const std::string& what) const { fail_at_line(node_.Mark().line, what); }

void StrictMap::fail_at(const std::string& key, const std::string& what) const {
  fail_at_line(node_[key] ? node_[key].Mark().line : node_.Mark().line, what);
}

void StrictMap::fail_at_line(int line, const std::string& what) const {
  throw InputError(fmt::format("{}:{}: {}", file_, line + 1, what));
}

void StrictMap::fail_conversion(const YAML::Node& node, const std::string& key,
                                const char* expected) const {
  const std::string found = node.IsScalar() ? "`" + node.Scalar() + "`" : "a list or a map";
  fail_at_line(node.Mark().line,
               fmt::format("{} is {}, expected {}", name_.empty() ? key : name_ + "." + key, found,
                           expected));
}

void StrictMap::operator()(const char* name, bool& value, const char*, const char*) {
  value = optional<bool>(name, value);
}

void StrictMap::operator()(const char* name, std::string& value, const char*, const char*) {
  value = optional<std::string>(name, value);
}

}  // namespace dxslam
