// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "bindings/map.h"

#include <fmt/format.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <array>
#include <filesystem>
#include <utility>

#include "bindings/arrays.h"
#include "bindings/bindings.h"
#include "bindings/images.h"
#include "bindings/interruptible.h"
#include "bindings/tables.h"
#include "core/error.h"
#include "map_files/map_export.h"
#include "map_files/map_merge.h"
#include "relocalization/relocalizer.h"
#include "slam/map_weld.h"
#include "slam/stored_system.h"
#include "slam/system_options.h"

namespace dxslam::python {

MapHandle::MapHandle(MapHeader header, std::shared_ptr<const Map> map,
                     std::vector<StoredLoopEdge> loops, std::vector<std::string> thumbnails,
                     std::string name)
    : header_(std::move(header)),
      map_(std::move(map)),
      loops_(std::move(loops)),
      thumbnails_(std::move(thumbnails)),
      name_(std::move(name)) {}

std::shared_ptr<MapHandle> MapHandle::of(StoredMap stored, std::string name) {
  auto map = std::make_shared<const Map>(std::move(stored.map));
  return std::make_shared<MapHandle>(std::move(stored.header), std::move(map),
                                     std::move(stored.loops), std::move(stored.thumbnails),
                                     std::move(name));
}

StoredMap MapHandle::copy() const {
  MapSnapshot snapshot = take_snapshot(header_, *map_, loops_, thumbnails_);
  return {snapshot.header, Map(std::move(snapshot.parts)), std::move(snapshot.loops),
          std::move(snapshot.thumbnails)};
}

const GlobalIndex& MapHandle::index() const {
  const std::lock_guard lock(mutex_);
  if (!index_) index_ = index_keyframes(*map_);
  return *index_;
}

SharedExtractor& MapHandle::extractor() {
  if (!extractor_) extractor_ = load_extractor(header_.extractor, {});
  return *extractor_;
}

namespace {

using MapPtr = std::shared_ptr<MapHandle>;

MapPtr merge(const MapPtr& map, const nb::args& others, bool apart) {
  std::vector<std::shared_ptr<const MapHandle>> all{map};
  for (const nb::handle other : others) {
    if (!nb::isinstance<MapHandle>(other)) throw nb::type_error("merge() takes other maps");
    all.push_back(nb::cast<MapPtr>(other));
  }
  return interruptible([all, apart] {
    StoredMap merged = all.front()->copy();
    for (std::size_t i = 1; i < all.size(); ++i) {
      MapSnapshot both = merge_maps(merged, all.front()->name(), all[i]->copy(), all[i]->name());
      merged = {both.header, Map(std::move(both.parts)), std::move(both.loops),
                std::move(both.thumbnails)};
    }
    if (!apart) weld_components(merged);
    return MapHandle::of(std::move(merged), "the merged map");
  });
}

void save(const MapHandle& map, const std::filesystem::path& file, bool exact_descriptors) {
  const std::string path = file.string();
  const auto lock = lock_map_target(path);
  MapFileOptions options;
  options.exact_descriptors = exact_descriptors;
  save_map(path, take_snapshot(map.header(), map.map(), map.loops(), map.thumbnails()), options);
}

KeyframeTable keyframes(const MapHandle& map) {
  auto rows = std::make_shared<std::vector<KeyframePose>>();
  for (const KeyframeId id : map.map().keyframe_ids()) {
    const Keyframe& k = map.map().keyframe(id);
    rows->push_back({id, k.component, k.frame->stamp, k.world_from_camera});
  }
  return {rows};
}

PointTable points(const MapHandle& map) {
  auto rows = std::make_shared<std::vector<PointPosition>>();
  for (const PointId id : map.map().point_ids()) {
    const MapPoint& point = map.map().point(id);
    rows->push_back(
        {id, map.map().keyframe(point.observations.front().keyframe).component, point.position});
  }
  return {rows};
}

const Camera& camera_for(const MapHandle& map, const std::optional<Camera>& camera) {
  if (camera) return *camera;
  const Rig& rig = map.map().rig();
  if (rig.size() != 1) {
    throw InputError(
        fmt::format("{} has {} cameras, expected `camera` to say which one took the "
                    "image",
                    map.name(), rig.size()));
  }
  return rig[0];
}

RelocalizationReport relocalize(MapHandle& map, const ImageArgument& color,
                                const std::optional<ImageArgument>& depth,
                                const std::optional<Camera>& other_camera,
                                SharedExtractor* extractor,
                                const std::optional<SystemOptions>& options) {
  const Camera& camera = camera_for(map, other_camera);
  if (extractor == nullptr) extractor = &map.extractor();
  require_same_features(map.header(), map_header(*extractor), map.name());
  RgbdImage image;
  image.color = color_image(color);
  if (depth) image.depth = depth_image(*depth, camera.depth_factor);
  require_size(image.color, image.depth, camera);
  RelocalizationReport report;
  {
    const nb::gil_scoped_release release;
    const Features features = extractor->extract(image.color, true);
    const FramePtr frame = make_frame(image, features, camera);
    const Relocalizer relocalizer(camera, extractor->traits(),
                                  options.value_or(SystemOptions()).relocalization);
    report = relocalizer.relocalize(map.map(), map.index(), *frame);
    image = {};
  }
  release_arrays();
  return report;
}

void bind_report(nb::module_& m) {
  nb::class_<RelocalizationReport>(m, "Relocalization",
                                   "Where in a map an image was taken. True where the pose may be "
                                   "relied on.")
      .def_ro("accepted", &RelocalizationReport::accepted, "Whether the pose may be relied on.")
      .def_prop_ro(
          "world_from_camera",
          [](const RelocalizationReport& r) {
            return r.has_pose ? std::optional(to_array(r.world_from_camera)) : std::nullopt;
          },
          kOwned,
          "(4, 4) float64, metres, in the world of `component`; of the best guess where it is not "
          "accepted, None where there is none.")
      .def_ro("confidence", &RelocalizationReport::confidence,
              "Calibrated probability that the pose is right, 0 to 1.")
      .def_ro("component", &RelocalizationReport::component, "Of the map.")
      .def_prop_ro(
          "reference",
          [](const RelocalizationReport& r) {
            return r.has_pose ? std::optional(r.reference) : std::nullopt;
          },
          "Id of the keyframe that shares most points with the image; None without a pose.")
      .def_ro("inliers", &RelocalizationReport::inliers, "Map points that agree with the pose.")
      .def_ro("visible", &RelocalizationReport::visible, "Map points that should be in view.")
      .def_ro("rms_pixels", &RelocalizationReport::rms_pixels, "Of the inliers, pixels.")
      .def("__bool__", [](const RelocalizationReport& r) { return r.accepted; })
      .def("__repr__", [](const RelocalizationReport& r) {
        return fmt::format("Relocalization(accepted={}, confidence={:.3f}, inliers={})",
                           r.accepted ? "True" : "False", r.confidence, r.inliers);
      });
}

void bind_keyframe(nb::module_& m) {
  nb::class_<Keyframe>(m, "Keyframe", "A keyframe of a map. Arrays have one row per keypoint.")
      .def_ro("id", &Keyframe::id, "Its id in the map.")
      .def_ro("component", &Keyframe::component, "The component in whose world it is.")
      .def_prop_ro(
          "stamp", [](const Keyframe& k) { return k.frame->stamp; }, "Seconds.")
      .def_prop_ro(
          "camera", [](const Keyframe& k) { return k.frame->camera; },
          "Which of Map.cameras took it.")
      .def_prop_ro(
          "world_from_camera", [](const Keyframe& k) { return to_array(k.world_from_camera); },
          kOwned, "(4, 4) float64, metres.")
      .def_prop_ro(
          "pixels",
          [](const Keyframe& k) {
            return rows_array<Array<float, -1, 2>>(
                k.frame->pixels, 2,
                [](const Eigen::Vector2f& p) { return std::array<float, 2>{p.x(), p.y()}; });
          },
          kOwned, "(N, 2) float32: x, y of the keypoints, undistorted (Camera.undistort).")
      .def_prop_ro(
          "depths",
          [](const Keyframe& k) {
            return column_array<float>(k.frame->depths, [](float depth) { return depth; });
          },
          kOwned, "(N,) float32, metres; 0: no reading.")
      .def_prop_ro(
          "descriptors", [](const Keyframe& k) { return descriptor_array(k.frame->descriptors); },
          kOwned, "(N, D) float32 or uint8. Read-only.")
      .def_prop_ro(
          "points",
          [](const Keyframe& k) {
            return column_array<std::int64_t>(k.points, [](PointId id) {
              return id == kNoId ? std::int64_t{-1} : static_cast<std::int64_t>(id);
            });
          },
          kOwned, "(N,) int64: ids of the points they are images of; -1: of none.");
}

void bind_files(nb::class_<MapHandle>& map) {
  map.def_static(
         "load",
         [](const std::filesystem::path& file) {
           return interruptible(
               [path = file.string()] { return MapHandle::of(load_map(path), path); });
         },
         nb::arg("path"),
         "Reads a map file. Raises InputError, with what is wrong, unless it is whole and sound.")
      .def("save", &save, nb::arg("path"), nb::kw_only(), nb::arg("exact_descriptors") = false,
           nb::call_guard<nb::gil_scoped_release>(),
           "Writes a map file, whole or not at all. `exact_descriptors`: floats as they are, four "
           "times as large. Raises InputError if it cannot be written.")
      .def("merge", &merge, nb::arg("others"), nb::arg("apart") = false,
           nb::sig("def merge(self, *others: Map, apart: bool = False) -> Map"),
           "This map and others in a new one, joined where they show one place; `apart`: not "
           "joined, components of their own. Keyframes get new ids. As `dxslam map merge`.")
      .def(
          "export_ply",
          [](const MapHandle& handle, const std::filesystem::path& path) {
            write_map_ply(path.string(), handle.map());
          },
          nb::arg("path"), nb::call_guard<nb::gil_scoped_release>(),
          "Writes points and keyframes as a PLY file.")
      .def(
          "export_colmap",
          [](const MapHandle& handle, const std::filesystem::path& folder) {
            write_map_colmap(folder.string(), handle.copy());
          },
          nb::arg("folder"), nb::call_guard<nb::gil_scoped_release>(),
          "Writes COLMAP's text files, one subfolder per component.");
}

void bind_content(nb::class_<MapHandle>& map) {
  map.def("keyframes", &keyframes, "All keyframes as arrays.")
      .def("points", &points, "All points as arrays.")
      .def(
          "keyframe",
          [](const MapHandle& handle, KeyframeId id) -> Keyframe {
            return handle.map().keyframe(id);
          },
          nb::arg("id"), "One keyframe with its keypoints. Raises ContractError for unknown ids.")
      .def(
          "thumbnail",
          [](const MapHandle& handle, KeyframeId id) -> std::optional<nb::bytes> {
            if (id >= handle.thumbnails().size() || handle.thumbnails()[id].empty()) return {};
            const std::string& jpeg = handle.thumbnails()[id];
            return nb::bytes(jpeg.data(), jpeg.size());
          },
          nb::arg("id"), "A small JPEG picture of the keyframe; None where the map has none.")
      .def_prop_ro(
          "loops",
          [](const MapHandle& handle) {
            return rows_array<Array<std::uint32_t, -1, 2>>(
                handle.loops(), 2,
                [](const StoredLoopEdge& l) { return std::array<std::uint32_t, 2>{l.a, l.b}; });
          },
          kOwned, "(L, 2) uint32: ids of keyframes that were found to see the same place.")
      .def_prop_ro(
          "cameras", [](const MapHandle& handle) { return handle.map().rig().cameras(); },
          "The cameras that took the keyframes.")
      .def_prop_ro(
          "features", [](const MapHandle& handle) { return handle.header().extractor; },
          "Name of the extractor it was made with.")
      .def("__repr__", [](const MapHandle& handle) {
        return fmt::format("Map({} keyframes, {} points, {})", handle.map().keyframe_count(),
                           handle.map().point_count(), handle.header().extractor);
      });
}

}  // namespace

void bind_map(nb::module_& m) {
  bind_report(m);
  bind_keyframe(m);
  nb::class_<MapHandle> map(m, "Map",
                            "Keyframes and points, of a file or of a System that has finished. "
                            "Immutable. Components are maps of their own world, until a place "
                            "joins them.");
  bind_files(map);
  bind_content(map);
  map.def("relocalize", &relocalize, nb::arg("image"), nb::arg("depth") = nb::none(), nb::kw_only(),
          nb::arg("camera") = nb::none(), nb::arg("extractor") = nb::none(),
          nb::arg("options") = nb::none(),
          "Finds the pose of one image without any idea where it is: (H, W, 3) uint8 BGR or (H, W) "
          "uint8, and (H, W) depth, float32 metres or uint16, or None. `camera`: what took it, "
          "where the map has several or another one did. `extractor`: where one is loaded already. "
          "`options`: their group `relocalization` counts. Raises InputError for images that do "
          "not fit the camera, or another extractor than the map's.");
}

}  // namespace dxslam::python
