// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "map_files/map_sections.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "io/primitives/text_file.h"
#include "map_files/map_limits.h"

namespace dxslam {
namespace {

// Plain records: what lies in the file, byte by byte.
struct StoredPose {
  double rotation[4];  // x y z w
  double translation[3];
};
static_assert(sizeof(StoredPose) == 56);

struct StoredKeyframe {
  std::int64_t index;
  double stamp;
  StoredPose world_from_camera;
  std::uint32_t parent;
  std::uint32_t component;
  std::uint32_t keypoints;
  std::uint32_t camera;
};
static_assert(sizeof(StoredKeyframe) == 88);

struct StoredPoint {
  double position[3];
  double normal[3];
  float distance;
  std::uint32_t created_by;
  std::uint32_t visible;
  std::uint32_t found;
  std::uint32_t descriptor;
  std::uint32_t observations;
};
static_assert(sizeof(StoredPoint) == 72);
static_assert(sizeof(PointObservation) == 8 && std::is_trivially_copyable_v<PointObservation>);

struct StoredLoop {
  std::uint32_t a;
  std::uint32_t b;
  StoredPose a_from_b;
};
static_assert(sizeof(StoredLoop) == 64);

// The header knows one lens, k1 k2 p1 p2 k3.
constexpr std::size_t kHeaderLensParameters = 5;
bool is_known_to_header(const Camera& camera) { return camera.lens.model == &kRadialTangential; }

// Bytes of a camera whose lens has a name of no letters.
constexpr std::size_t kSmallestCamera = 8 + 10 * 8 + 4 + Lens::kMaxParameters * 8;

StoredPose stored(const SE3& pose) {
  StoredPose out;
  Eigen::Map<Eigen::Vector4d>(out.rotation) = pose.rotation().coeffs();
  Eigen::Map<Eigen::Vector3d>(out.translation) = pose.translation();
  return out;
}

SE3 restored(const StoredPose& stored, const SectionReader& reader,
             double farthest = kFarthestInMap) {
  const Eigen::Quaterniond rotation(Eigen::Map<const Eigen::Vector4d>(stored.rotation));
  const Eigen::Vector3d translation(Eigen::Map<const Eigen::Vector3d>(stored.translation));
  // Before it is normalised.
  const bool unit = std::abs(rotation.norm() - 1.0) < 1e-6;
  const SE3 pose(unit ? rotation : Eigen::Quaterniond::Identity(), translation);
  if (!unit || !is_possible(pose, farthest)) {
    reader.fail(fmt::format("a pose that is no rigid motion of at most {} m", farthest));
  }
  return pose;
}

}  // namespace

void write_header(const MapHeader& header, const Rig& rig, SectionWriter& file) {
  file.begin(kHeaderId, kSectionVersion, true);
  const Camera& c = rig[0];
  file.put(static_cast<std::int32_t>(c.width));
  file.put(static_cast<std::int32_t>(c.height));
  for (const double value : {c.fx, c.fy, c.cx, c.cy}) file.put(value);
  const Lens lens = is_known_to_header(c) ? c.lens : Lens();
  for (std::size_t i = 0; i < kHeaderLensParameters; ++i) file.put(lens.parameters[i]);
  for (const double value :
       {c.fps, c.depth_factor, c.depth_baseline, c.disparity_noise, c.max_depth}) {
    file.put(value);
  }
  file.put(static_cast<std::uint32_t>(header.traits.binary ? 1 : 0));
  file.put(static_cast<std::int32_t>(header.traits.dimension));
  file.put(static_cast<std::int32_t>(header.traits.global_dimension));
  file.put(header.traits.max_distance);
  file.put_text(header.extractor);
  file.put_text(header.model_hash);
}

MapHeader read_header(SectionReader reader, Rig& rig, const std::string& where) {
  MapHeader header;
  Camera c;
  c.width = reader.get<std::int32_t>();
  c.height = reader.get<std::int32_t>();
  for (double* const value : {&c.fx, &c.fy, &c.cx, &c.cy}) *value = reader.get<double>();
  for (std::size_t i = 0; i < kHeaderLensParameters; ++i) {
    c.lens.parameters[i] = reader.get<double>();
  }
  for (double* const value :
       {&c.fps, &c.depth_factor, &c.depth_baseline, &c.disparity_noise, &c.max_depth}) {
    *value = reader.get<double>();
  }
  c.prepare(where);
  rig = Rig(c);
  const auto binary = reader.get<std::uint32_t>();
  if (binary > 1) reader.fail(fmt::format("descriptors of kind {}", binary));
  DescriptorTraits& traits = header.traits;
  traits.binary = binary == 1;
  traits.dimension = reader.get<std::int32_t>();
  traits.global_dimension = reader.get<std::int32_t>();
  traits.max_distance = reader.get<float>();
  if (!is_possible(traits)) {
    reader.fail(fmt::format("descriptors of {} and {} numbers, {} apart at most", traits.dimension,
                            traits.global_dimension, traits.max_distance));
  }
  header.extractor = reader.get_text();
  header.model_hash = reader.get_text();
  reader.expect_end();
  return header;
}

void write_cameras(const Rig& rig, SectionWriter& file) {
  const bool header_says_all =
      rig.size() == 1 && is_known_to_header(rig[0]) && rig[0].readout_time == 0.0;
  if (header_says_all) return;
  // A program that does not know this section would take keypoints for another camera's.
  file.begin(kCamerasId, kSectionVersion, rig.size() > 1 || !is_known_to_header(rig[0]));
  file.put(static_cast<std::uint32_t>(rig.size()));
  for (const Camera& c : rig.cameras()) {
    file.put(static_cast<std::int32_t>(c.width));
    file.put(static_cast<std::int32_t>(c.height));
    for (const double value : {c.fx, c.fy, c.cx, c.cy, c.fps, c.depth_factor, c.depth_baseline,
                               c.disparity_noise, c.max_depth, c.readout_time}) {
      file.put(value);
    }
    file.put_text(c.lens.model->name);
    for (const double value : c.lens.parameters) file.put(value);
  }
}

Rig read_cameras(SectionReader reader, const std::string& where) {
  const std::size_t count = reader.get_count(kSmallestCamera);
  if (count == 0 || count > kMostCameras) reader.fail(fmt::format("{} cameras", count));
  Rig rig;
  for (std::size_t i = 0; i < count; ++i) {
    Camera c;
    c.width = reader.get<std::int32_t>();
    c.height = reader.get<std::int32_t>();
    for (double* const value :
         {&c.fx, &c.fy, &c.cx, &c.cy, &c.fps, &c.depth_factor, &c.depth_baseline,
          &c.disparity_noise, &c.max_depth, &c.readout_time}) {
      *value = reader.get<double>();
    }
    const std::string name = reader.get_text();
    c.lens.model = find_lens_model(name);
    if (c.lens.model == nullptr) {
      throw InputError(fmt::format(
          "{}: map file with a camera of lens {}, which this program does not know; a newer "
          "dxslam wrote it",
          where, in_quotes(name)));
    }
    for (double& value : c.lens.parameters) value = reader.get<double>();
    c.prepare(where);
    if (rig.add(c) != i) reader.fail("the same camera twice");
  }
  reader.expect_end();
  return rig;
}

void write_keyframes(const MapParts& parts, SectionWriter& file) {
  file.begin(kKeyframesId, kSectionVersion, true);
  file.put(static_cast<std::uint32_t>(parts.keyframes.size()));
  file.put(parts.last_keyframe);
  for (const Keyframe& k : parts.keyframes) {
    StoredKeyframe out{};
    out.index = k.frame->index;
    out.stamp = k.frame->stamp;
    out.world_from_camera = stored(k.world_from_camera);
    out.parent = k.parent;
    out.component = k.component;
    out.keypoints = static_cast<std::uint32_t>(k.frame->size());
    out.camera = k.frame->camera;
    file.put(out);
  }
}

void read_keyframes(SectionReader reader, std::size_t max_keypoints, MapParts& parts,
                    std::vector<std::shared_ptr<Frame>>& frames) {
  const auto count = reader.get<std::uint32_t>();
  parts.last_keyframe = reader.get<KeyframeId>();
  const std::string_view records = reader.take(count, sizeof(StoredKeyframe));
  reader.expect_end();
  parts.keyframes.resize(count);
  frames.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    StoredKeyframe in;
    std::memcpy(&in, records.data() + i * sizeof in, sizeof in);
    if (!is_possible_index(in.index) || !is_possible_stamp(in.stamp)) {
      reader.fail(fmt::format("index or stamp of keyframe {}", i));
    }
    if (in.keypoints > std::min(max_keypoints, kMostFrameKeypoints)) {
      reader.fail("more keypoints than the file or a frame can have");
    }
    max_keypoints -= in.keypoints;
    auto frame = std::make_shared<Frame>();
    if (!parts.rig.has(in.camera)) {
      reader.fail(fmt::format("keyframe {} of camera {} of {}", i, in.camera, parts.rig.size()));
    }
    frame->camera = in.camera;
    frame->index = in.index;
    frame->stamp = in.stamp;
    frame->pixels.resize(in.keypoints);
    Keyframe& k = parts.keyframes[i];
    k.id = static_cast<KeyframeId>(i);
    k.world_from_camera = restored(in.world_from_camera, reader);
    k.parent = in.parent;
    k.component = in.component;
    k.frame = frame;
    frames.push_back(std::move(frame));
  }
}

void write_points(const MapParts& parts, SectionWriter& file) {
  file.begin(kPointsId, kSectionVersion, true);
  file.put(static_cast<std::uint32_t>(parts.points.size()));
  for (const MapPoint& p : parts.points) {
    StoredPoint out{};
    Eigen::Map<Eigen::Vector3d>(out.position) = p.position;
    Eigen::Map<Eigen::Vector3d>(out.normal) = p.normal;
    out.distance = p.distance;
    out.created_by = p.created_by;
    out.visible = p.visible;
    out.found = p.found;
    out.descriptor = p.descriptor;
    out.observations = static_cast<std::uint32_t>(p.observations.size());
    file.put(out);
  }
  for (const MapPoint& p : parts.points) {
    file.put_array(p.observations.data(), p.observations.size());
  }
}

void read_points(SectionReader reader, MapParts& parts) {
  const std::size_t count = reader.get_count(sizeof(StoredPoint));
  const std::string_view records = reader.take(count, sizeof(StoredPoint));
  parts.points.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    StoredPoint in;
    std::memcpy(&in, records.data() + i * sizeof in, sizeof in);
    MapPoint& p = parts.points[i];
    p.id = static_cast<PointId>(i);
    p.position = Eigen::Map<const Eigen::Vector3d>(in.position);
    p.normal = Eigen::Map<const Eigen::Vector3d>(in.normal);
    p.distance = in.distance;
    p.created_by = in.created_by;
    p.visible = in.visible;
    p.found = in.found;
    p.descriptor = in.descriptor;
    if (!is_possible(p)) reader.fail(fmt::format("impossible numbers in point {}", i));
    const std::string_view seen = reader.take(in.observations, sizeof(PointObservation));
    p.observations.resize(in.observations);
    if (!seen.empty()) std::memcpy(p.observations.data(), seen.data(), seen.size());
  }
  reader.expect_end();
}

void write_loops(const std::vector<StoredLoopEdge>& loops, SectionWriter& file) {
  if (loops.empty()) return;
  file.begin(kLoopsId, kSectionVersion, false);
  file.put(static_cast<std::uint32_t>(loops.size()));
  for (const StoredLoopEdge& loop : loops) {
    file.put(StoredLoop{loop.a, loop.b, stored(loop.a_from_b)});
  }
}

std::vector<StoredLoopEdge> read_loops(SectionReader reader, const MapParts& parts) {
  const std::size_t count = reader.get_count(sizeof(StoredLoop));
  std::vector<StoredLoopEdge> loops;
  loops.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto in = reader.get<StoredLoop>();
    if (in.a == in.b || in.a >= parts.keyframes.size() || in.b >= parts.keyframes.size() ||
        parts.keyframes[in.a].component != parts.keyframes[in.b].component) {
      reader.fail(fmt::format("a loop between keyframes {} and {}", in.a, in.b));
    }
    loops.push_back({in.a, in.b, restored(in.a_from_b, reader, kLongestLoopEdge)});
  }
  reader.expect_end();
  return loops;
}

void write_thumbnails(const std::vector<std::string>& thumbnails, SectionWriter& file) {
  if (thumbnails.empty()) return;
  file.begin(kThumbnailsId, kSectionVersion, false);
  for (const std::string& picture : thumbnails) {
    file.put(static_cast<std::uint32_t>(picture.size()));
    file.put_array(picture.data(), picture.size());
  }
}

std::vector<std::string> read_thumbnails(SectionReader reader, std::size_t keyframes) {
  std::vector<std::string> thumbnails;
  thumbnails.reserve(keyframes);
  for (std::size_t i = 0; i < keyframes; ++i) {
    const auto size = reader.get<std::uint32_t>();
    if (size > kLargestThumbnail) reader.fail(fmt::format("a thumbnail of {} bytes", size));
    thumbnails.emplace_back(reader.take(size, 1));
  }
  reader.expect_end();
  return thumbnails;
}

}  // namespace dxslam
