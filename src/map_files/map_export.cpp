// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "map_files/map_export.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <set>

#include "core/error.h"
#include "io/formats/ply_file.h"
#include "io/primitives/atomic_file.h"

namespace dxslam {
namespace {

constexpr double kOftenSeen = 10.0;         // observations; the brightest colour
constexpr double kColmapPixelCentre = 0.5;  // ours is 0

double seen_share(const MapPoint& p) {
  return std::min(1.0, static_cast<double>(p.observations.size()) / kOftenSeen);
}

std::uint32_t component_of(const Map& map, const MapPoint& p) {
  return map.keyframe(p.observations.front().keyframe).component;
}

std::string cameras_text(const Camera& c) {
  const double x = c.cx + kColmapPixelCentre;
  const double y = c.cy + kColmapPixelCentre;
  const std::string intrinsics = fmt::format("{:.9g} {:.9g} {:.9g} {:.9g}", c.fx, c.fy, x, y);
  const std::string size = fmt::format("{} {}", c.width, c.height);
  const std::string model =
      c.has_distortion() ? fmt::format("FULL_OPENCV {} {} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g} 0 0 0",
                                       size, intrinsics, c.k1, c.k2, c.p1, c.p2, c.k3)
                         : fmt::format("PINHOLE {} {}", size, intrinsics);
  return fmt::format("# CAMERA_ID MODEL WIDTH HEIGHT PARAMS[]\n1 {}\n", model);
}

std::string image_name(const Keyframe& k, std::set<std::string>& taken) {
  std::string name = fmt::format("{:.6f}.png", k.frame->stamp);
  if (!taken.insert(name).second) name = fmt::format("{:.6f}_{}.png", k.frame->stamp, k.id);
  return name;
}

void write_thumbnail(const std::filesystem::path& folder, const StoredMap& stored, KeyframeId id,
                     const std::string& name) {
  if (id >= stored.thumbnails.size() || stored.thumbnails[id].empty()) return;
  make_folder(folder.string());
  std::filesystem::path file = folder / name;
  write_file_atomically(file.replace_extension(".jpg").string(), stored.thumbnails[id]);
}

void append_image(const Keyframe& k, const Camera& camera, const std::string& name,
                  std::string& text) {
  const SE3 camera_from_world = k.world_from_camera.inverse();
  const Eigen::Quaterniond& q = camera_from_world.rotation();
  const Eigen::Vector3d& t = camera_from_world.translation();
  auto out = std::back_inserter(text);
  fmt::format_to(out, "{} {:.12g} {:.12g} {:.12g} {:.12g} {:.9g} {:.9g} {:.9g} 1 {}\n", k.id + 1,
                 q.w(), q.x(), q.y(), q.z(), t.x(), t.y(), t.z(), name);
  const char* separator = "";
  for (std::size_t i = 0; i < k.frame->size(); ++i) {
    const Eigen::Vector2d raw = camera.distort(k.frame->pixels[i].cast<double>());
    fmt::format_to(out, "{}{:.4f} {:.4f} {}", separator, raw.x() + kColmapPixelCentre,
                   raw.y() + kColmapPixelCentre,
                   k.points[i] == kNoId ? std::int64_t{-1} : std::int64_t{k.points[i]} + 1);
    separator = " ";
  }
  text += '\n';
}

// Mean distance in pixels of where the keyframes see a point to where it should be; COLMAP's error.
double mean_error(const Map& map, const MapPoint& p, const Camera& camera) {
  double sum = 0.0;
  int count = 0;
  for (const PointObservation& o : p.observations) {
    const Keyframe& k = map.keyframe(o.keyframe);
    const Eigen::Vector3d in_camera = k.world_from_camera.inverse() * p.position;
    const double error2 =
        camera.squared_error(in_camera, k.frame->pixels[o.keypoint].cast<double>());
    if (std::isinf(error2)) continue;  // behind the camera
    sum += std::sqrt(error2);
    ++count;
  }
  return count > 0 ? sum / count : -1.0;
}

void append_point(const Map& map, const MapPoint& p, const Camera& camera, std::string& text) {
  const Rgb color = color_of_score(seen_share(p));
  auto out = std::back_inserter(text);
  fmt::format_to(out, "{} {:.9g} {:.9g} {:.9g} {} {} {} {:.6g}", std::int64_t{p.id} + 1,
                 p.position.x(), p.position.y(), p.position.z(), color[0], color[1], color[2],
                 mean_error(map, p, camera));
  for (const PointObservation& o : p.observations) {
    fmt::format_to(out, " {} {}", std::int64_t{o.keyframe} + 1, o.keypoint);
  }
  text += '\n';
}

}  // namespace

void write_map_ply(const std::string& path, const Map& map, std::uint32_t component) {
  std::vector<PlyPoint> points;
  for (const PointId id : map.point_ids()) {
    const MapPoint& p = map.point(id);
    if (component != kNoId && component_of(map, p) != component) continue;
    points.push_back({p.position, color_of_score(seen_share(p))});
  }
  std::vector<Eigen::Vector3d> centres;
  for (const KeyframeId id : map.keyframe_ids()) {
    const Keyframe& k = map.keyframe(id);
    if (component != kNoId && k.component != component) continue;
    centres.push_back(k.world_from_camera.translation());
  }
  write_ply(path, points, centres);
}

void write_map_colmap(const std::string& folder, const StoredMap& stored) {
  namespace fs = std::filesystem;
  const Map& map = stored.map;
  const Camera& camera = stored.header.camera;
  for (std::uint32_t component = 0; component < map.component_count(); ++component) {
    const fs::path model = fs::path(folder) / std::to_string(component);
    make_folder(model.string());
    std::string images = "# IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME\n# X Y POINT3D_ID ...\n";
    std::set<std::string> names;
    for (const KeyframeId id : map.keyframe_ids()) {
      const Keyframe& k = map.keyframe(id);
      if (k.component != component) continue;
      const std::string name = image_name(k, names);
      append_image(k, camera, name, images);
      write_thumbnail(model / "thumbnails", stored, id, name);
    }
    std::string points = "# POINT3D_ID X Y Z R G B ERROR TRACK[] as IMAGE_ID POINT2D_IDX\n";
    for (const PointId id : map.point_ids()) {
      const MapPoint& p = map.point(id);
      if (component_of(map, p) == component) append_point(map, p, camera, points);
    }
    write_file_atomically((model / "cameras.txt").string(), cameras_text(camera));
    write_file_atomically((model / "images.txt").string(), images);
    write_file_atomically((model / "points3D.txt").string(), points);
  }
}

}  // namespace dxslam
