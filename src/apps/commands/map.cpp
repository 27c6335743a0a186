// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/command_files.h"
#include "apps/commands.h"
#include "apps/console.h"
#include "apps/map_target.h"
#include "apps/output_steps.h"
#include "apps/recording_report.h"
#include "apps/usage.h"
#include "core/error.h"
#include "io/formats/ply_file.h"
#include "io/primitives/atomic_file.h"
#include "io/primitives/json_text.h"
#include "map_files/map_export.h"
#include "map_files/map_file.h"
#include "map_files/map_merge.h"
#include "map_files/map_statistics.h"
#include "slam/map_weld.h"

namespace dxslam::apps {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kMebibyte = 1024.0 * 1024.0;

struct MapArguments {
  std::vector<std::string> files;
  std::string out;
  std::string json;
  std::string ply;
  std::string colmap;
  std::string thumbnails;
  int component = -1;
  bool apart = false;
};

Json sections_table(const std::string& path) {
  Json sections = Json::array();
  for (const MapFileSection& s : list_map_sections(path)) {
    sections.push_back({{"id", s.id}, {"version", s.version}, {"bytes", s.size}});
  }
  return sections;
}

Json components_table(const MapStatistics& statistics) {
  Json components = Json::array();
  for (const ComponentSize& c : statistics.components) {
    components.push_back({{"keyframes", c.keyframes},
                          {"points", c.points},
                          {"first_stamp", c.first_stamp},
                          {"last_stamp", c.last_stamp},
                          {"extent_m", c.extent}});
  }
  return components;
}

Json describe_map(const std::string& path, const StoredMap& stored, const MapStatistics& s) {
  const DescriptorTraits& traits = stored.header.traits;
  Json report;
  report["file"] = path;
  report["bytes"] = std::filesystem::file_size(path);
  report["sections"] = sections_table(path);
  report["cameras"] = Json::array();
  for (const Camera& c : stored.map.rig().cameras()) report["cameras"].push_back(camera_json(c));
  report["features"] = stored.header.extractor;
  report["model_sha256"] = stored.header.model_hash;
  report["descriptors"] = {{"kind", traits.binary ? "binary" : "float"},
                           {"dimension", traits.dimension},
                           {"global_dimension", traits.global_dimension}};
  report["keyframes"] = stored.map.keyframe_count();
  report["points"] = stored.map.point_count();
  report["keypoints"] = s.keypoints;
  report["observations"] = s.observations;
  report["global_descriptors"] = s.globals;
  report["loops"] = stored.loops.size();
  report["thumbnails"] =
      stored.thumbnails.size() -
      static_cast<std::size_t>(std::count(stored.thumbnails.begin(), stored.thumbnails.end(), ""));
  report["components"] = components_table(s);
  report["reprojection_error_px"] = {{"median", s.median_error}, {"p95", s.p95_error}};
  return report;
}

void print_info(const StoredMap& stored, const MapStatistics& s, double bytes) {
  const MapHeader& header = stored.header;
  const double keyframes =
      static_cast<double>(std::max<std::size_t>(1, stored.map.keyframe_count()));
  print("features      {}, {} {} per keypoint{}\n", header.extractor, header.traits.dimension,
        header.traits.binary ? "bytes" : "floats",
        header.model_hash.empty() ? "" : ", weights " + header.model_hash.substr(0, 12));
  for (const Camera& c : stored.map.rig().cameras()) {
    print("camera        {}x{}, fx {:.2f} fy {:.2f} cx {:.2f} cy {:.2f}{}\n", c.width, c.height,
          c.fx, c.fy, c.cx, c.cy,
          c.has_distortion() ? fmt::format(", lens {}", c.lens.model->name) : "");
  }
  print("size          {:.1f} MiB, {:.1f} KiB per keyframe\n", bytes / kMebibyte,
        bytes / 1024.0 / keyframes);
  print("keyframes     {}, {} of them with a global descriptor\n", stored.map.keyframe_count(),
        s.globals);
  print("keypoints     {}\n", s.keypoints);
  print("points        {}, seen {} times\n", stored.map.point_count(), s.observations);
  print("loops         {}\n", stored.loops.size());
  for (std::size_t i = 0; i < s.components.size(); ++i) {
    const ComponentSize& part = s.components[i];
    print("component {:<3} {}, {}, {:.1f} m, stamps {:.3f} to {:.3f}\n", i,
          counted(part.keyframes, "keyframe"), counted(part.points, "point"), part.extent,
          part.first_stamp, part.last_stamp);
  }
}

void info_command(const MapArguments& arguments) {
  const std::string& path = arguments.files.front();
  CommandFiles(arguments.files)
      .writes("--json", arguments.json,
              json_kind("a description of `dxslam map info`", {"file", "bytes"}));
  const StoredMap stored = load_map(path);
  const MapStatistics statistics = map_statistics(stored);
  print_info(stored, statistics, static_cast<double>(std::filesystem::file_size(path)));
  for (const MapFileSection& s : list_map_sections(path)) {
    print("section {}  version {}, {:.2f} MiB\n", s.id, s.version,
          static_cast<double>(s.size) / kMebibyte);
  }
  if (arguments.json.empty()) return;
  write_file_atomically(arguments.json, to_json_text(describe_map(path, stored, statistics)));
}

void check_command(const MapArguments& arguments) {
  const StoredMap stored = load_map(arguments.files.front());
  const MapStatistics s = map_statistics(stored);
  print("checksums     right\n");
  print("relations     sound: {}, {}, {}, {}\n", counted(stored.map.keyframe_count(), "keyframe"),
        counted(stored.map.point_count(), "point"), counted(s.observations, "observation"),
        counted(stored.loops.size(), "loop"));
  print("reprojection  {:.2f} px median, {:.2f} px 95 %\n", s.median_error, s.p95_error);
  print("behind camera {}\n", counted(s.behind, "observation"));
  print("connected     {} of covisible keyframes in {}\n", counted(s.covisible_groups, "group"),
        counted(s.components.size(), "component"));
  print("blind         {} without a point in view\n", counted(s.blind_keyframes, "keyframe"));
}

void export_command(const MapArguments& arguments) {
  if (arguments.ply.empty() && arguments.colmap.empty() && arguments.thumbnails.empty()) {
    throw CLI::RequiredError("--ply, --colmap or --thumbnails");
  }
  const std::string& path = arguments.files.front();
  CommandFiles(arguments.files).writes("--ply", arguments.ply, ply_kind());
  const StoredMap stored = load_map(path);
  const std::uint32_t components = stored.map.component_count();
  const auto component = static_cast<std::uint32_t>(arguments.component);
  if (arguments.component >= 0 && component >= components) {
    throw InputError(
        fmt::format("{}: has no component {}, expected less than {}", path, component, components));
  }
  OutputSteps steps;
  if (!arguments.ply.empty()) {
    steps.run([&] {
      write_map_ply(arguments.ply, stored.map, arguments.component < 0 ? kNoId : component);
    });
  }
  if (!arguments.colmap.empty()) steps.run([&] { write_map_colmap(arguments.colmap, stored); });
  if (!arguments.thumbnails.empty()) {
    steps.run([&] {
      print("{}\n", counted(write_map_thumbnails(arguments.thumbnails, stored), "thumbnail"));
    });
  }
  steps.end_command();
}

void merge_command(const MapArguments& arguments) {
  CommandFiles(arguments.files).writes("--out", arguments.out);
  MapTarget target(arguments.out, "");
  StoredMap merged = load_map(arguments.files.front());
  for (std::size_t i = 1; i < arguments.files.size(); ++i) {
    const std::string& path = arguments.files[i];
    MapSnapshot both = merge_maps(merged, arguments.files.front(), load_map(path), path);
    merged = {both.header, Map(std::move(both.parts)), std::move(both.loops),
              std::move(both.thumbnails)};
  }
  const std::size_t loops = arguments.apart ? 0 : weld_components(merged);
  const MapSnapshot snapshot =
      take_snapshot(merged.header, merged.map, merged.loops, merged.thumbnails);
  target.prepare();
  save_map(arguments.out, snapshot);
  target.finish();
  std::uint32_t components = 0;
  for (const Keyframe& k : snapshot.parts.keyframes) {
    components = std::max(components, k.component + 1);
  }
  print("{} and {} in {}; {}\n", counted(snapshot.parts.keyframes.size(), "keyframe"),
        counted(snapshot.parts.points.size(), "point"), counted(components, "component"),
        counted(loops, "common place"));
}

CLI::App* add_action(CLI::App& map, const char* name, const char* about,
                     void (*action)(const MapArguments&), std::shared_ptr<MapArguments>& arguments,
                     bool several = false) {
  CLI::App* command = map.add_subcommand(name, about);
  arguments = std::make_shared<MapArguments>();
  CLI::Option* files =
      command->add_option("MAP", arguments->files, several ? "map files" : "map file")->required();
  several ? files->expected(2, 1000) : files->expected(1);
  command->callback([action, arguments] { action(*arguments); });
  return command;
}

}  // namespace

void add_map_command(CLI::App& app) {
  CLI::App* map = app.add_subcommand("map", "look at, check, merge and export saved maps");
  map->require_subcommand(1);
  std::shared_ptr<MapArguments> arguments;
  add_action(*map, "info", "what a map holds", info_command, arguments)
      ->add_option("--json", arguments->json, "also write it to a JSON file")
      ->option_text("FILE");

  add_action(*map, "check", "whether a map file is whole and sound, and how well its parts fit",
             check_command, arguments);

  CLI::App* exporting =
      add_action(*map, "export", "write a map for other programs", export_command, arguments);
  exporting->parse_complete_callback([exporting] {
    refuse_unused(*exporting, "--component", exporting->count("--ply") > 0, "with --ply");
  });
  exporting->add_option("--ply", arguments->ply, "points and keyframes as a PLY file")
      ->option_text("FILE");
  exporting
      ->add_option("--colmap", arguments->colmap,
                   "COLMAP text files and thumbnails, one subfolder for each component")
      ->option_text("DIR");
  exporting->add_option("--thumbnails", arguments->thumbnails, "pictures of the keyframes")
      ->option_text("DIR");
  exporting->add_option("--component", arguments->component, "only this one into the PLY file")
      ->check(whole_number(0))
      ->option_text("N");

  CLI::App* merge =
      add_action(*map, "merge", "put maps into one file and join them where they show one place",
                 merge_command, arguments, true);
  merge->add_flag("--apart", arguments->apart, "do not join them: components of their own");
  merge->add_option("--out", arguments->out, "the new map file")->option_text("FILE")->required();
}

}  // namespace dxslam::apps
