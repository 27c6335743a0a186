// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "map_files/map_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string_view>
#include <system_error>

#include "core/error.h"
#include "io/primitives/atomic_file.h"
#include "io/primitives/output_file.h"
#include "io/primitives/text_file.h"
#include "map_files/file_bytes.h"
#include "map_files/map_limits.h"
#include "map_files/map_sections.h"
#include "map_files/section_file.h"

namespace dxslam {
namespace {

constexpr std::size_t kLongestInLock = 200;  // bytes of a map's name in that of its lock

FileBytes read_bytes(const std::string& path) {
  return FileBytes(
      path, "a dxslam map", kLargestMapFile, kStartBytes,
      [&](std::string_view start, std::size_t size) { check_start(start, size, path); });
}

// Points that a file could not hold, far beyond all walls, are no loss.
void drop_impossible_points(std::vector<MapPoint>& points) {
  points.erase(std::remove_if(points.begin(), points.end(),
                              [](const MapPoint& p) { return !is_possible(p); }),
               points.end());
  for (std::size_t i = 0; i < points.size(); ++i) points[i].id = static_cast<PointId>(i);
}

KeyframeId number_of(const std::vector<KeyframeId>& ids, KeyframeId id) {
  return static_cast<KeyframeId>(std::lower_bound(ids.begin(), ids.end(), id) - ids.begin());
}

// Upper bound of what the sections take, so that the file is built in place.
std::size_t expected_size(const MapSnapshot& snapshot, DescriptorCoding coding) {
  std::size_t keypoints = 0;
  for (const Keyframe& k : snapshot.parts.keyframes) keypoints += k.frame->size();
  std::size_t observations = 0;
  for (const MapPoint& p : snapshot.parts.points) observations += p.observations.size();
  std::size_t pictures = 0;
  for (const std::string& picture : snapshot.thumbnails) pictures += picture.size() + 4;
  const auto global = static_cast<std::size_t>(snapshot.header.traits.global_dimension);
  return 4096 + snapshot.parts.rig.size() * 256 +
         snapshot.parts.keyframes.size() * (96 + global * sizeof(float)) +
         keypoints * keypoint_size(coding, snapshot.header.traits.dimension) +
         snapshot.parts.points.size() * 80 + observations * 8 + snapshot.loops.size() * 64 +
         pictures;
}

// The sections of a file by name: the first of a kind counts.
class Sections {
 public:
  Sections(std::vector<Section> sections, const std::string& where)
      : sections_(std::move(sections)), where_(where) {
    for (const Section& s : sections_) check_known(s);
  }

  SectionReader needed(const char* id) const {
    const Section* section = find(id);
    if (section == nullptr) {
      throw InputError(fmt::format("{}: damaged map file: section {} is missing", where_, id));
    }
    return {*section, where_};
  }
  std::optional<SectionReader> optional(const char* id) const {
    const Section* section = find(id);
    if (section == nullptr) return std::nullopt;
    return SectionReader(*section, where_);
  }

 private:
  // A section of a version that is not known is as good as none.
  const Section* find(const std::string& id) const {
    const auto it = std::find_if(sections_.begin(), sections_.end(), [&](const Section& s) {
      return s.id == id && s.version == kSectionVersion;
    });
    return it == sections_.end() ? nullptr : &*it;
  }

  void check_known(const Section& s) const {
    const char* const known[] = {kHeaderId,  kCamerasId, kKeyframesId, kKeypointsId,
                                 kGlobalsId, kPointsId,  kLoopsId,     kThumbnailsId};
    const bool is_known = s.version == kSectionVersion &&
                          std::find(std::begin(known), std::end(known), s.id) != std::end(known);
    if (is_known || !s.required) return;
    throw InputError(fmt::format(
        "{}: map file with a section {} of version {}, which this program does not know; a newer "
        "dxslam wrote it",
        where_, in_quotes(s.id), s.version));
  }

  std::vector<Section> sections_;
  std::string where_;
};

MapParts read_parts(const Sections& sections, const DescriptorTraits& traits, Rig rig,
                    const std::string& where) {
  MapParts parts;
  parts.rig = std::move(rig);
  if (const auto cameras = sections.optional(kCamerasId)) parts.rig = read_cameras(*cameras, where);
  std::vector<std::shared_ptr<Frame>> frames;
  const SectionReader keypoints = sections.needed(kKeypointsId);
  read_keyframes(sections.needed(kKeyframesId), keypoint_capacity(keypoints, traits), parts,
                 frames);
  read_keypoints(keypoints, traits, parts.rig, frames);
  if (const auto globals = sections.optional(kGlobalsId); globals && traits.global_dimension > 0) {
    read_globals(*globals, traits, frames);
  }
  read_points(sections.needed(kPointsId), parts);
  return parts;
}

std::string features_of(const MapHeader& header) {
  return fmt::format("`{}` ({} {})", header.extractor, header.traits.dimension,
                     header.traits.binary ? "bytes" : "floats");
}

const FileKind& map_kind() {
  static const FileKind kind{"a map", begins_like_a_map};
  return kind;
}

}  // namespace

MapSnapshot take_snapshot(const MapHeader& header, const Map& map,
                          const std::vector<StoredLoopEdge>& loops,
                          const std::vector<std::string>& thumbnails) {
  MapSnapshot snapshot{header, take_apart(map), {}, {}};
  drop_impossible_points(snapshot.parts.points);
  const std::vector<KeyframeId> ids = map.keyframe_ids();
  for (const StoredLoopEdge& loop : loops) {
    const Map::Anchor a = map.anchor_of(loop.a);
    const Map::Anchor b = map.anchor_of(loop.b);
    if (a.keyframe == b.keyframe ||
        map.keyframe(a.keyframe).component != map.keyframe(b.keyframe).component) {
      continue;
    }
    snapshot.loops.push_back(
        {number_of(ids, a.keyframe), number_of(ids, b.keyframe),
         a.anchor_from_camera * loop.a_from_b * b.anchor_from_camera.inverse()});
  }
  if (thumbnails.empty()) return snapshot;
  for (const KeyframeId id : ids) {
    snapshot.thumbnails.push_back(id < thumbnails.size() ? thumbnails[id] : std::string());
  }
  return snapshot;
}

void require_map_target(const std::string& path) { require_target(path, map_kind()); }

std::unique_ptr<FileLock> lock_map_target(const std::string& path) {
  namespace fs = std::filesystem;
  require_map_target(path);
  std::error_code error;
  if (fs::exists(path, error) && !fs::is_regular_file(path, error)) return nullptr;  // a stream
  const fs::path target = canonical_target(path);
  const std::string name = "." + target.filename().string().substr(0, kLongestInLock) + ".lock";
  try {
    return std::make_unique<FileLock>(
        (target.parent_path() / name).string(),
        fmt::format(
            "{}: another process is about to save its map there, expected a file of its own "
            "for each",
            path));
  } catch (const std::system_error& e) {
    throw InputError(fmt::format("{}: cannot be locked: {}", path, e.code().message()));
  }
}

void save_map(const std::string& path, const MapSnapshot& snapshot, const MapFileOptions& options) {
  require(
      snapshot.thumbnails.empty() || snapshot.thumbnails.size() == snapshot.parts.keyframes.size(),
      "there must be one thumbnail per keyframe, or none at all");
  check_numbers(snapshot, path);
  static_cast<void>(Map(snapshot.parts));  // throws for what could not be loaded again
  const DescriptorTraits& traits = snapshot.header.traits;
  const DescriptorCoding floats =
      options.exact_descriptors ? DescriptorCoding::kFloat32 : DescriptorCoding::kInt8;
  const DescriptorCoding coding = traits.binary ? DescriptorCoding::kBytes : floats;
  require_kind_or_nothing(path, map_kind());
  SectionWriter file(expected_size(snapshot, coding));
  write_header(snapshot.header, snapshot.parts.rig, file);
  write_cameras(snapshot.parts.rig, file);
  write_keyframes(snapshot.parts, file);
  write_keypoints(snapshot.parts, traits, coding, file);
  write_globals(snapshot.parts, traits, floats, file);
  write_points(snapshot.parts, file);
  write_loops(snapshot.loops, file);
  write_thumbnails(snapshot.thumbnails, file);
  const std::string bytes = file.finish();
  if (bytes.size() > kLargestMapFile) {
    throw InputError(fmt::format("{}: the map is not saved: {} bytes, expected at most {}", path,
                                 bytes.size(), kLargestMapFile));
  }
  remove_stale_temporaries(path);
  write_file_atomically(path, bytes);
}

StoredMap load_map(const std::string& path) {
  const FileBytes file = read_bytes(path);
  return parse_map(file.data(), file.size(), path);
}

StoredMap parse_map(const char* bytes, std::size_t size, const std::string& where) {
  const Sections sections(read_sections({bytes, size}, where), where);
  Rig rig;
  MapHeader header = read_header(sections.needed(kHeaderId), rig, where);
  MapParts parts = read_parts(sections, header.traits, std::move(rig), where);
  if (parts.keyframes.empty()) {
    throw InputError(where + ": a map without keyframes, expected at least one");
  }
  if (!is_possible_covisibility(parts)) {
    throw InputError(where + ": damaged map file: too many pairs of keyframes share points");
  }
  std::vector<StoredLoopEdge> loops;
  if (const auto section = sections.optional(kLoopsId)) loops = read_loops(*section, parts);
  std::vector<std::string> thumbnails;
  if (const auto section = sections.optional(kThumbnailsId)) {
    thumbnails = read_thumbnails(*section, parts.keyframes.size());
  }
  try {
    return {std::move(header), Map(std::move(parts)), std::move(loops), std::move(thumbnails)};
  } catch (const ContractError& e) {
    throw InputError(fmt::format("{}: damaged map file: {}", where, e.what()));
  }
}

std::vector<MapFileSection> list_map_sections(const std::string& path) {
  const FileBytes file = read_bytes(path);
  std::vector<MapFileSection> list;
  for (const Section& s : read_sections({file.data(), file.size()}, path)) {
    list.push_back({s.id, s.version, s.bytes.size()});
  }
  return list;
}

void require_same_features(const MapHeader& map, const MapHeader& current,
                           const std::string& where) {
  const bool same_descriptors = map.traits.binary == current.traits.binary &&
                                map.traits.dimension == current.traits.dimension &&
                                map.traits.global_dimension == current.traits.global_dimension;
  const bool hashes = !map.model_hash.empty() && !current.model_hash.empty();
  if (same_descriptors &&
      (hashes ? map.model_hash == current.model_hash : map.extractor == current.extractor)) {
    return;
  }
  const bool other_weights = same_descriptors && map.extractor == current.extractor;
  throw InputError(
      fmt::format("{}: the map was made with features {}, in use is {}{}; their descriptors "
                  "cannot be compared",
                  where, features_of(map), features_of(current),
                  other_weights ? " of another training (the weights' hashes differ)" : ""));
}

}  // namespace dxslam
