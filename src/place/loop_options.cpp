// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "place/loop_options.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"

namespace dxslam {
namespace {

constexpr const char* kGeometry = "+geometry";

std::vector<LoopMethod> make_methods() {
  std::vector<LoopMethod> methods(5);
  methods[0].name = "orb-bow";
  methods[0].orb = true;
  methods[1].name = "hf-bow";
  methods[2].name = "hf-bow-global";
  methods[2].global = true;
  methods[2].agree = true;
  methods[3].name = "hf-bow-global-paper";
  methods[3].global = true;
  methods[4].name = "global-only";
  methods[4].words = false;
  methods[4].global = true;
  const std::size_t plain = methods.size();
  for (std::size_t i = 0; i < plain; ++i) {
    LoopMethod method = methods[i];
    method.name += kGeometry;
    method.geometry = true;
    methods.push_back(std::move(method));
  }
  return methods;
}

const std::vector<LoopMethod>& methods() {
  static const std::vector<LoopMethod> table = make_methods();
  return table;
}

}  // namespace

const std::vector<std::string>& loop_method_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const LoopMethod& method : methods()) all.push_back(method.name);
    return all;
  }();
  return names;
}

LoopMethod parse_loop_method(const std::string& name) {
  const auto found = std::find_if(methods().begin(), methods().end(),
                                  [&](const LoopMethod& method) { return method.name == name; });
  if (found != methods().end()) return *found;
  throw InputError(fmt::format("no loop detection method '{}', expected one of {}", name,
                               fmt::join(loop_method_names(), ", ")));
}

}  // namespace dxslam
