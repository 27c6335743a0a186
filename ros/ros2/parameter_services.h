// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <memory>
#include <vector>

namespace dxslam::ros2 {

class Entity;
class Node;
class Parameters;

/// The six services by which other programs read and set the parameters of a node.
class ParameterServices {
 public:
  /// `parameters` must outlive it.
  ParameterServices(Node& node, Parameters& parameters);

 private:
  std::vector<std::shared_ptr<Entity>> services_;
};

}  // namespace dxslam::ros2
