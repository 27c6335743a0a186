// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "map_files/map_export.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <set>
#include <utility>

#include "core/error.h"
#include "io/formats/ply_file.h"
#include "io/primitives/atomic_file.h"
#include "io/primitives/output_file.h"
#include "io/primitives/picture_mark.h"

namespace dxslam {
namespace {

constexpr double kOftenSeen = 10.0;         // observations; the brightest colour
constexpr double kColmapPixelCentre = 0.5;  // ours is 0

// COLMAP's own files begin with other words.
constexpr const char* kCameras = "# CAMERA_ID MODEL WIDTH HEIGHT PARAMS[]\n";
constexpr const char* kImages = "# IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME\n";
constexpr const char* kPoints = "# POINT3D_ID X Y Z R G B ERROR TRACK[] as IMAGE_ID POINT2D_IDX\n";

constexpr const char* kSoftware = "dxslam";  // wrote the pictures

double seen_share(const MapPoint& p) {
  return std::min(1.0, static_cast<double>(p.observations.size()) / kOftenSeen);
}

std::uint32_t component_of(const Map& map, const MapPoint& p) {
  return map.keyframe(p.observations.front().keyframe).component;
}

// COLMAP does not know every lens: keypoints of the others are given undistorted.
bool is_known_to_colmap(const Camera& c) {
  return c.has_distortion() && c.lens.model->colmap_name != nullptr;
}

std::string camera_text(const Camera& c) {
  const double x = c.cx + kColmapPixelCentre;
  const double y = c.cy + kColmapPixelCentre;
  std::string text = is_known_to_colmap(c) ? c.lens.model->colmap_name : "PINHOLE";
  text += fmt::format(" {} {} {:.9g} {:.9g} {:.9g} {:.9g}", c.width, c.height, c.fx, c.fy, x, y);
  for (std::size_t i = 0; is_known_to_colmap(c) && i < c.lens.model->colmap_parameters; ++i) {
    text += fmt::format(" {:.9g}", c.lens.parameters[i]);
  }
  return text;
}

std::string cameras_text(const Rig& rig) {
  std::string text = kCameras;
  for (std::size_t i = 0; i < rig.size(); ++i) {
    text += fmt::format("{} {}\n", i + 1, camera_text(rig[static_cast<CameraId>(i)]));
  }
  return text;
}

std::string image_name(const Keyframe& k, std::set<std::string>& taken) {
  std::string name = fmt::format("{:.6f}.png", k.frame->stamp);
  if (!taken.insert(name).second) name = fmt::format("{:.6f}_{}.png", k.frame->stamp, k.id);
  return name;
}

// False where the keyframe has none.
bool write_thumbnail(const std::filesystem::path& folder, const StoredMap& stored, KeyframeId id,
                     const std::string& name) {
  if (id >= stored.thumbnails.size() || stored.thumbnails[id].empty()) return false;
  const std::string& picture = stored.thumbnails[id];
  make_folder(folder.string());
  const std::string path = (folder / name).replace_extension(".jpg").string();
  require_kind_or_nothing(path, marked_picture_kind("a picture of `dxslam map`", kSoftware));
  write_file_atomically(path, mark_picture(picture, kSoftware));
  return true;
}

void require_colmap_target(const std::filesystem::path& model) {
  for (const auto& [name, beginning] :
       {std::pair("cameras.txt", kCameras), std::pair("images.txt", kImages),
        std::pair("points3D.txt", kPoints)}) {
    require_kind_or_nothing((model / name).string(),
                            kind_by_beginning("a COLMAP file of dxslam", {beginning}));
  }
}

void append_image(const Keyframe& k, const Camera& camera, const std::string& name,
                  std::string& text) {
  const SE3 camera_from_world = k.world_from_camera.inverse();
  const Eigen::Quaterniond& q = camera_from_world.rotation();
  const Eigen::Vector3d& t = camera_from_world.translation();
  auto out = std::back_inserter(text);
  fmt::format_to(out, "{} {:.12g} {:.12g} {:.12g} {:.12g} {:.9g} {:.9g} {:.9g} {} {}\n", k.id + 1,
                 q.w(), q.x(), q.y(), q.z(), t.x(), t.y(), t.z(), k.frame->camera + 1, name);
  const char* separator = "";
  for (std::size_t i = 0; i < k.frame->size(); ++i) {
    const Eigen::Vector2d pixel = k.frame->pixels[i].cast<double>();
    const Eigen::Vector2d raw = is_known_to_colmap(camera) ? camera.distort(pixel) : pixel;
    fmt::format_to(out, "{}{:.4f} {:.4f} {}", separator, raw.x() + kColmapPixelCentre,
                   raw.y() + kColmapPixelCentre,
                   k.points[i] == kNoId ? std::int64_t{-1} : std::int64_t{k.points[i]} + 1);
    separator = " ";
  }
  text += '\n';
}

// Mean distance in pixels of where the keyframes see a point to where it should be; COLMAP's error.
double mean_error(const Map& map, const MapPoint& p) {
  double sum = 0.0;
  int count = 0;
  for (const PointObservation& o : p.observations) {
    const Keyframe& k = map.keyframe(o.keyframe);
    const Eigen::Vector3d in_camera = k.world_from_camera.inverse() * p.position;
    const double error2 =
        map.camera_of(k.id).squared_error(in_camera, k.frame->pixels[o.keypoint].cast<double>());
    if (std::isinf(error2)) continue;  // behind the camera
    sum += std::sqrt(error2);
    ++count;
  }
  return count > 0 ? sum / count : -1.0;
}

void append_point(const Map& map, const MapPoint& p, std::string& text) {
  const Rgb color = color_of_score(seen_share(p));
  auto out = std::back_inserter(text);
  fmt::format_to(out, "{} {:.9g} {:.9g} {:.9g} {} {} {} {:.6g}", std::int64_t{p.id} + 1,
                 p.position.x(), p.position.y(), p.position.z(), color[0], color[1], color[2],
                 mean_error(map, p));
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
  for (std::uint32_t component = 0; component < map.component_count(); ++component) {
    require_colmap_target(fs::path(folder) / std::to_string(component));
  }
  for (std::uint32_t component = 0; component < map.component_count(); ++component) {
    const fs::path model = fs::path(folder) / std::to_string(component);
    make_folder(model.string());
    std::string images = fmt::format("{}# X Y POINT3D_ID ...\n", kImages);
    std::set<std::string> names;
    for (const KeyframeId id : map.keyframe_ids()) {
      const Keyframe& k = map.keyframe(id);
      if (k.component != component) continue;
      const std::string name = image_name(k, names);
      append_image(k, map.camera_of(id), name, images);
      write_thumbnail(model / "thumbnails", stored, id, name);
    }
    std::string points = kPoints;
    for (const PointId id : map.point_ids()) {
      const MapPoint& p = map.point(id);
      if (component_of(map, p) == component) append_point(map, p, points);
    }
    write_file_atomically((model / "cameras.txt").string(), cameras_text(map.rig()));
    write_file_atomically((model / "images.txt").string(), images);
    write_file_atomically((model / "points3D.txt").string(), points);
  }
}

std::size_t write_map_thumbnails(const std::string& folder, const StoredMap& stored) {
  if (std::all_of(stored.thumbnails.begin(), stored.thumbnails.end(),
                  [](const std::string& picture) { return picture.empty(); })) {
    throw InputError(fmt::format(
        "{}: the map has no thumbnails to write there, expected one of `dxslam run --thumbnails`",
        folder));
  }
  make_folder(folder);
  std::size_t written = 0;
  for (KeyframeId id = 0; id < stored.thumbnails.size(); ++id) {
    written += write_thumbnail(folder, stored, id, fmt::format("{:06d}", id)) ? 1 : 0;
  }
  return written;
}

}  // namespace dxslam
