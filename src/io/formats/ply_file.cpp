// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/formats/ply_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "io/primitives/atomic_file.h"

namespace dxslam {
namespace {

constexpr Rgb kKeyframeColor{220, 30, 30};
constexpr const char* kBeginning =
    "ply\nformat binary_little_endian 1.0\ncomment metres, world frame";

// The bytes as they are in memory: the program is built for little-endian machines only.
template <class Value>
void append(std::string& bytes, Value value) {
  char raw[sizeof(Value)];
  std::memcpy(raw, &value, sizeof(Value));
  bytes.append(raw, sizeof(Value));
}

void append_vertex(std::string& bytes, const Eigen::Vector3d& position, const Rgb& color) {
  for (int i = 0; i < 3; ++i) append(bytes, static_cast<float>(position[i]));
  for (const std::uint8_t channel : color) append(bytes, channel);
}

}  // namespace

Rgb color_of_score(double score) {
  static constexpr double kStops[][3] = {
      {30, 20, 90}, {60, 80, 160}, {40, 150, 140}, {120, 205, 80}, {250, 230, 50}};
  constexpr int kSegments = static_cast<int>(std::size(kStops)) - 1;
  const double at = kSegments * (score > 0.0 ? std::min(score, 1.0) : 0.0);
  const int segment = std::min(static_cast<int>(at), kSegments - 1);
  Rgb color;
  for (std::size_t i = 0; i < 3; ++i) {
    const double from = kStops[segment][i];
    color[i] = static_cast<std::uint8_t>(
        std::lround(from + (at - segment) * (kStops[segment + 1][i] - from)));
  }
  return color;
}

FileKind ply_kind() { return kind_by_beginning("a PLY file of dxslam", {kBeginning}); }

void write_ply(const std::string& path, const std::vector<PlyPoint>& points,
               const std::vector<Eigen::Vector3d>& keyframe_centres) {
  std::string vertices;
  std::size_t count = 0;
  for (const PlyPoint& point : points) {
    if (!point.position.allFinite()) continue;
    append_vertex(vertices, point.position, point.color);
    ++count;
  }
  std::string edges;
  std::size_t centres = 0;
  for (const Eigen::Vector3d& centre : keyframe_centres) {
    if (!centre.allFinite()) continue;
    append_vertex(vertices, centre, kKeyframeColor);
    if (centres > 0) {
      append(edges, static_cast<std::int32_t>(count + centres - 1));
      append(edges, static_cast<std::int32_t>(count + centres));
    }
    ++centres;
  }
  const std::string header = fmt::format(
      "{}; the last {} vertices are keyframe centres\nelement vertex {}\nproperty float "
      "x\nproperty float y\nproperty float z\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\nelement edge {}\n"
      "property int vertex1\nproperty int vertex2\nend_header\n",
      kBeginning, centres, count + centres, centres == 0 ? 0 : centres - 1);
  write_file_atomically(path, header + vertices + edges);
}

}  // namespace dxslam
