// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

namespace dxslam {

/// The document in `text`; `where` names it in messages. What exceeds the YAML limits of limits.h
/// is refused while it is read, before anything is built of it: yaml-cpp's maps take time that
/// grows with the square of their size. Throws InputError, "FILE:LINE: ...".
YAML::Node parse_yaml(const std::string& text, const std::string& where);

/// Entry `key` of a map; a node that is not defined where there is none, or `node` is no map.
YAML::Node yaml_child(const YAML::Node& node, const std::string& key);

/// The line of a mark, from 1; yaml-cpp counts from 0, and -1 stands for "unknown".
int yaml_line(const YAML::Mark& mark);

}  // namespace dxslam
