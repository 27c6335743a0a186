// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <yaml-cpp/yaml.h>

#include <optional>
#include <string>
#include <vector>

namespace dxslam {

/// The document in `text`; `where` names it in messages. What exceeds the YAML limits of limits.h
/// is refused while it is read, before anything is built of it: yaml-cpp's maps take time that
/// grows with the square of their size. Throws InputError, "FILE:LINE: ...".
YAML::Node parse_yaml(const std::string& text, const std::string& where);

/// Entry `key` of a map; a node that is not defined where there is none, or `node` is no map.
YAML::Node yaml_child(const YAML::Node& node, const std::string& key);

/// Its text; empty where it is no scalar.
std::string yaml_scalar(const YAML::Node& node);
/// Its numbers; nothing unless it is a list of finite numbers alone.
std::optional<std::vector<double>> finite_numbers(const YAML::Node& list);

/// parse_yaml() for OpenCV's dialect as well, whose first line "%YAML:1.0" is not YAML.
YAML::Node parse_opencv_yaml(const std::string& text, const std::string& where);

/// The line of a mark, from 1; yaml-cpp counts from 0, and -1 stands for "unknown".
int yaml_line(const YAML::Mark& mark);

}  // namespace dxslam
