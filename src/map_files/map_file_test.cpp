// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "map_files/map_file.h"

#include <fmt/format.h>

#include <array>
#include <functional>

#include "io/primitives/test_folder.h"
#include "map_files/crc32c.h"
#include "map_files/map_limits.h"
#include "map_files/map_sections.h"
#include "map_files/test_map_files.h"

namespace dxslam {
namespace {

TEST(MapFile, HoldsAllOfAMap) {
  for (const bool binary : {false, true}) {
    const TestFolder folder;
    const MapSnapshot snapshot = sample_snapshot(6, binary);
    save_map(folder / "m.dxmap", snapshot);
    const StoredMap stored = load_map(folder / "m.dxmap");
    const Map original(snapshot.parts);
    expect_same_maps(original, stored.map);
    expect_consistent(stored.map);
    EXPECT_EQ(descriptor_difference(original, stored.map) > 0.0, !binary);
    EXPECT_LT(descriptor_difference(original, stored.map), 0.004);
    EXPECT_EQ(stored.header.extractor, snapshot.header.extractor);
    EXPECT_EQ(stored.header.model_hash, snapshot.header.model_hash);
    EXPECT_EQ(stored.header.traits.binary, binary);
    EXPECT_EQ(stored.header.traits.dimension, 32);
    EXPECT_EQ(stored.header.traits.global_dimension, binary ? 0 : 16);
    EXPECT_EQ(stored.header.traits.max_distance, snapshot.header.traits.max_distance);
    EXPECT_EQ(stored.map.rig().cameras(), snapshot.parts.rig.cameras());
    ASSERT_EQ(stored.loops.size(), 1U);
    EXPECT_EQ(stored.loops[0].b, 2U);  // keyframe 3, since keyframe 2 was removed
    EXPECT_LT((stored.loops[0].a_from_b.matrix() - snapshot.loops[0].a_from_b.matrix()).norm(),
              1e-14);
    const std::vector<std::string> thumbnails = {"jpeg", "", "more jpeg", "", "", "", ""};
    EXPECT_EQ(stored.thumbnails, thumbnails);
  }
}

TEST(MapFile, KeepsDescriptorsExactlyWhereAsked) {
  const TestFolder folder;
  const MapSnapshot snapshot = sample_snapshot();
  save_map(folder / "m.dxmap", snapshot, {true});
  EXPECT_EQ(descriptor_difference(Map(snapshot.parts), load_map(folder / "m.dxmap").map), 0.0);
}

TEST(MapFile, IsTheSameAfterLoadingAndSaving) {
  const TestFolder folder;
  save_map(folder / "a", sample_snapshot());
  const StoredMap stored = load_map(folder / "a");
  save_map(folder / "b", take_snapshot(stored.header, stored.map, stored.loops, stored.thumbnails));
  const StoredMap again = load_map(folder / "b");
  expect_same_maps(stored.map, again.map);
  EXPECT_EQ(descriptor_difference(stored.map, again.map), 0.0);
}

// The file as it would be with all checksums right, whatever its numbers are.
std::string unchecked_bytes(const MapSnapshot& snapshot, DescriptorCoding coding) {
  SectionWriter file(1000);
  write_header(snapshot.header, snapshot.parts.rig, file);
  write_cameras(snapshot.parts.rig, file);
  write_keyframes(snapshot.parts, file);
  write_keypoints(snapshot.parts, snapshot.header.traits, coding, file);
  write_globals(snapshot.parts, snapshot.header.traits, coding, file);
  write_points(snapshot.parts, file);
  write_loops(snapshot.loops, file);
  write_thumbnails(snapshot.thumbnails, file);
  return file.finish();
}

TEST(MapFile, IsNeverOfAnEmptyMap) {
  const TestFolder folder;
  Map map;
  map.add_camera(test_camera());
  const MapSnapshot empty = take_snapshot(sample_header(), map);
  save_map(folder / "m", sample_snapshot());
  expect_input_error([&] { save_map(folder / "m", empty); },
                     {"m: the map is not saved", "no keyframe"});
  EXPECT_NO_THROW(load_map(folder / "m"));
  const std::string file = unchecked_bytes(empty, DescriptorCoding::kInt8);
  expect_input_error([&] { parse_map(file.data(), file.size(), "f"); },
                     {"f: a map without keyframes"});
}

// Every number has its bounds, the same for saving and for loading.
TEST(MapFile, HoldsNoImpossibleNumbers) {
  const TestFolder folder;
  const double infinity = std::numeric_limits<double>::infinity();
  save_map(folder / "m", sample_snapshot());
  const std::string good = folder.read("m");
  int kinds = 0;
  const auto expect_refused = [&](const auto& spoil) {
    MapSnapshot s = sample_snapshot();
    auto frame = std::make_shared<Frame>(*s.parts.keyframes[1].frame);
    frame->descriptors = frame->descriptors.clone();
    spoil(s, *frame);
    s.parts.keyframes[1].frame = frame;
    EXPECT_THROW(save_map(folder / "m", s), InputError) << kinds;
    const std::string file = unchecked_bytes(s, DescriptorCoding::kFloat32);
    EXPECT_THROW(parse_map(file.data(), file.size(), "f"), InputError) << kinds;
    ++kinds;
  };
  const auto in_frame = [&](const auto& spoil) {
    expect_refused([&](MapSnapshot&, Frame& f) { spoil(f); });
  };
  const auto in_point = [&](const auto& spoil) {
    expect_refused([&](MapSnapshot& s, Frame&) { spoil(s.parts.points[3]); });
  };
  in_frame([&](Frame& f) { f.descriptors.at<float>(1, 1) = std::nanf(""); });
  in_frame([&](Frame& f) { f.descriptors.at<float>(1, 1) = 3.0F; });
  in_frame([&](Frame& f) { f.global[2] = -1e30F; });
  in_frame([&](Frame& f) { f.pixels[0].x() = std::nanf(""); });
  in_frame([&](Frame& f) { f.pixels[0].y() = -1e5F; });
  in_frame([&](Frame& f) { f.depths[0] = -1.0F; });
  in_frame([&](Frame& f) { f.depths[0] = 1e-20F; });
  in_frame([&](Frame& f) { f.sigmas[0] = 0.0F; });
  in_frame([&](Frame& f) { f.sigmas[0] = 1e9F; });
  in_frame([&](Frame& f) { f.scores[0] = std::nanf(""); });
  in_frame([&](Frame& f) { f.stamp = infinity; });
  in_frame([&](Frame& f) { f.index = -1; });
  in_point([&](MapPoint& p) { p.position.z() = 1e7; });
  in_point([&](MapPoint& p) { p.normal.x() = 5.0; });
  in_point([&](MapPoint& p) { p.distance = -1.0F; });
  in_point([&](MapPoint& p) { p.visible = 0xFFFFFFFFU; });
  const SE3 far(Eigen::Quaterniond::Identity(), {0.0, 1e300, 0.0});
  expect_refused([&](MapSnapshot& s, Frame&) { s.parts.keyframes[2].world_from_camera = far; });
  expect_refused([&](MapSnapshot& s, Frame&) { s.loops[0].a_from_b = far; });
  expect_refused([&](MapSnapshot& s, Frame&) { s.thumbnails[0].resize(std::size_t{2} << 20); });
  Camera camera = test_camera();
  camera.fx = -1.0;
  expect_refused([&](MapSnapshot& s, Frame&) { s.parts.rig = Rig(camera); });
  camera = test_camera();
  camera.lens.parameters[0] = -5.0;
  expect_refused([&](MapSnapshot& s, Frame&) { s.parts.rig = Rig(camera); });
  expect_refused([&](MapSnapshot& s, Frame&) { s.header.traits.max_distance = std::nanf(""); });
  EXPECT_EQ(folder.read("m"), good);
}

TEST(MapFile, LeavesOutPointsThatAreTooFarAway) {
  Map map = sample_map(5);
  const std::size_t points = map.point_count();
  const PointId far = map.point_ids()[4];
  map.set_position(far, {1e9, 0.0, 0.0});
  const TestFolder folder;
  save_map(folder / "m", take_snapshot(sample_header(), map));
  const StoredMap stored = load_map(folder / "m");
  EXPECT_EQ(stored.map.point_count(), points - 1);
  expect_consistent(stored.map);
}

// The edge between two of them is longer than each is far from the origin.
TEST(MapFile, HoldsLoopsBetweenTheFarthestKeyframes) {
  const TestFolder folder;
  MapSnapshot s = sample_snapshot();
  SE3& a = s.parts.keyframes[s.loops[0].a].world_from_camera;
  SE3& b = s.parts.keyframes[s.loops[0].b].world_from_camera;
  a = SE3(so3_exp({0.1, 0.2, 0.3}), {1e6, 0.0, 0.0});
  b = SE3(so3_exp({0.3, 0.2, 0.1}), {-1e6, 0.0, 0.0});
  s.loops[0].a_from_b = a.inverse() * b;
  save_map(folder / "m", s);
  EXPECT_NEAR(load_map(folder / "m").loops[0].a_from_b.translation().norm(), 2e6, 1e-6);
}

TEST(MapFile, OfOthersThatHurtIsRefused) {
  const char* const shared = std::getenv("DXSLAM_SHARED");
  const std::string cases =
      std::string(shared != nullptr ? shared : DXSLAM_SOURCE_DIR "/../shared") + "/cases/";
  if (!std::filesystem::exists(cases)) GTEST_SKIP() << cases << " is not at hand";
  expect_input_error([&] { load_map(cases + "empty_map.dxmap"); }, {"without keyframes"});
  expect_input_error([&] { load_map(cases + "huge_pose.dxmap"); }, {"KEYF", "keyframe 0"});
}

TEST(MapFile, HoldsKeyframesWithoutKeypoints) {
  const TestFolder folder;
  Map map = sample_map(4);
  map.add_keyframe(std::make_shared<Frame>(), SE3(), 1);
  save_map(folder / "m", take_snapshot(sample_header(), map));
  const StoredMap stored = load_map(folder / "m");
  expect_consistent(stored.map);
  // As wide as the others: what is copied from them goes into rows of theirs.
  const Frame& empty = *stored.map.keyframe(stored.map.last_keyframe()).frame;
  EXPECT_EQ(empty.size(), 0U);
  EXPECT_EQ(empty.descriptors.cols, stored.header.traits.dimension);
  EXPECT_EQ(empty.descriptors.type(), CV_32FC1);
}

TEST(MapFile, MovesLoopsOfRemovedKeyframesToTheirAnchors) {
  Map map = sample_map(5);  // 2 was removed and hangs on 1
  const Map::Anchor anchor = map.anchor_of(2);
  ASSERT_EQ(anchor.keyframe, 1U);
  const SE3 a_from_b(so3_exp({0.1, 0, 0}), {1, 2, 3});
  const MapSnapshot snapshot =
      take_snapshot(sample_header(), map, {{4, 2, a_from_b}, {1, 2, SE3()}, {1, 6, SE3()}});
  ASSERT_EQ(snapshot.loops.size(), 1U);
  EXPECT_EQ(snapshot.loops[0].a, 3U);
  EXPECT_EQ(snapshot.loops[0].b, 1U);
  const SE3 expected = a_from_b * anchor.anchor_from_camera.inverse();
  EXPECT_LT((snapshot.loops[0].a_from_b.matrix() - expected.matrix()).norm(), 1e-12);
}

TEST(MapFile, DoesNotSaveWhatCouldNotBeLoaded) {
  const TestFolder folder;
  const auto expect_refused = [&](const auto& spoil) {
    MapSnapshot snapshot = sample_snapshot();
    auto frame = std::make_shared<Frame>(*snapshot.parts.keyframes[1].frame);
    frame->descriptors = frame->descriptors.clone();
    spoil(*frame);
    snapshot.parts.keyframes[1].frame = frame;
    EXPECT_THROW(save_map(folder / "m", snapshot), ContractError);
    EXPECT_FALSE(std::filesystem::exists(folder / "m"));
  };
  expect_refused([](Frame& f) { f.scores.pop_back(); });
  expect_refused([](Frame& f) { f.global.resize(5); });
  expect_refused([](Frame& f) { f.descriptors.convertTo(f.descriptors, CV_8U); });
  MapSnapshot snapshot = sample_snapshot();
  snapshot.parts.points[3].observations[0].keypoint = 100000;
  EXPECT_THROW(save_map(folder / "m", snapshot), ContractError);
  snapshot = sample_snapshot();
  snapshot.thumbnails.pop_back();
  EXPECT_THROW(save_map(folder / "m", snapshot), ContractError);
}

// What a later program may do: more sections, some of which must be understood.
std::string with_section(const MapSnapshot& snapshot, const char* id, std::uint32_t version,
                         bool required) {
  SectionWriter file(1000);
  file.begin(id, version, required);
  file.put_text("from the future");
  write_header(snapshot.header, snapshot.parts.rig, file);
  write_keyframes(snapshot.parts, file);
  write_keypoints(snapshot.parts, snapshot.header.traits, DescriptorCoding::kInt8, file);
  write_globals(snapshot.parts, snapshot.header.traits, DescriptorCoding::kInt8, file);
  write_points(snapshot.parts, file);
  return file.finish();
}

TEST(MapFile, ReplacesMapsAlone) {
  const TestFolder folder;
  const MapSnapshot snapshot = sample_snapshot(3, true);
  folder.write("photo.jpg", "not a map");
  for (const auto& action : {std::function<void(const std::string&)>(require_map_target),
                             std::function<void(const std::string&)>(
                                 [&](const std::string& path) { save_map(path, snapshot); })}) {
    expect_input_error([&] { action(folder / "photo.jpg"); }, {"photo.jpg", "not a map"});
    expect_input_error([&] { action(folder / "missing/m.dxmap"); }, {"missing/m.dxmap"});
    expect_input_error([&] { action(folder.path()); }, {folder.path()});
  }
  EXPECT_EQ(folder.read("photo.jpg"), "not a map");
  folder.write("new.dxmap", "");
  save_map(folder / "new.dxmap", snapshot);
  const std::string bytes = folder.read("new.dxmap");
  require_map_target(folder / "new.dxmap");
  EXPECT_EQ(folder.read("new.dxmap"), bytes);
}

TEST(MapFile, SkipsSectionsItNeedNotKnow) {
  const MapSnapshot snapshot = sample_snapshot();
  for (const char* id : {"NEWS", "LOOP"}) {
    const std::string file = with_section(snapshot, id, 2, false);
    const StoredMap stored = parse_map(file.data(), file.size(), "f");
    expect_same_maps(stored.map, Map(snapshot.parts));
    EXPECT_TRUE(stored.loops.empty());
  }
}

TEST(MapFile, RefusesSectionsItWouldHaveToKnow) {
  const MapSnapshot snapshot = sample_snapshot();
  for (const char* id : {"NEWS", "KEYF"}) {
    const std::string file = with_section(snapshot, id, 2, true);
    expect_input_error([&] { parse_map(file.data(), file.size(), "f"); },
                       {id, "version 2", "a newer dxslam wrote it"});
  }
}

TEST(MapFile, RefusesAnotherFormat) {
  const TestFolder folder;
  save_map(folder / "m", sample_snapshot());
  std::string file = folder.read("m");
  file[8] = 2;
  const std::uint32_t checksum = crc32c(file.data(), 28);
  std::memcpy(&file[28], &checksum, sizeof checksum);
  expect_input_error([&] { parse_map(file.data(), file.size(), "f"); }, {"f: ", "format 2"});
}

TEST(MapFile, RefusesFilesWithoutANeededSection) {
  SectionWriter file(1000);
  write_header(sample_header(), Rig(test_camera()), file);
  const std::string bytes = file.finish();
  expect_input_error([&] { parse_map(bytes.data(), bytes.size(), "f"); }, {"is missing"});
}

TEST(MapFile, RefusesWhatIsNoFile) {
  const TestFolder folder;
  expect_input_error([&] { load_map(folder / "none"); }, {"none: no such file", "dxslam map"});
  expect_input_error([&] { load_map(folder.path()); }, {"not a regular file"});
  folder.write("large", "not a map");
  std::filesystem::resize_file(folder / "large", std::uintmax_t{1} << 39);  // takes no place
  expect_input_error([&] { load_map(folder / "large"); }, {"is no dxslam map"});
  folder.write("trajectory.txt", "1.0 0 0 0 0 0 0 1\n");
  expect_input_error([&] { load_map(folder / "trajectory.txt"); }, {"is no dxslam map"});
  expect_input_error([&] { save_map(folder / "no/m", sample_snapshot()); }, {"cannot be written"});
}

constexpr std::size_t kV1Keyframes = 5;
constexpr std::size_t kV1Points = 39;
constexpr double kV1X = 0.16;
constexpr float kV1Descriptor = -0.35772026F;
constexpr float kV1Pixel = 253.69647F;
constexpr double kV1Z = 4.481328520998917;

// A file of the first version, saved on 2026-11-22: later programs must read it.
TEST(MapFile, ReadsTheFirstVersion) {
  const StoredMap stored = load_map(DXSLAM_SOURCE_DIR "/tests/data/map_v1.dxmap");
  EXPECT_EQ(stored.header.extractor, "sample");
  EXPECT_EQ(stored.header.model_hash, std::string(64, 'a'));
  EXPECT_EQ(stored.header.traits.dimension, 32);
  EXPECT_EQ(stored.map.rig()[0].cx, 319.5);
  ASSERT_EQ(stored.map.keyframe_count(), kV1Keyframes);
  ASSERT_EQ(stored.map.point_count(), kV1Points);
  EXPECT_EQ(stored.map.component_count(), 2U);
  expect_consistent(stored.map);
  const Keyframe& k = stored.map.keyframe(1);
  EXPECT_EQ(k.frame->index, 1);
  EXPECT_EQ(k.frame->stamp, 1.0 / 30.0);
  EXPECT_NEAR(k.world_from_camera.translation().x(), kV1X, 1e-12);
  EXPECT_NEAR(cv::norm(k.frame->descriptors.row(0)), 1.0, 1e-5);
  EXPECT_NEAR(k.frame->descriptors.at<float>(0, 0), kV1Descriptor, 1e-6);
  EXPECT_EQ(k.frame->pixels[0].x(), kV1Pixel);
  EXPECT_NEAR(k.frame->global[1], 0.8, 0.01);
  EXPECT_NEAR(stored.map.point(7).position.z(), kV1Z, 1e-12);
  ASSERT_EQ(stored.loops.size(), 1U);
  EXPECT_NEAR(stored.loops[0].a_from_b.translation().z(), 2.0, 1e-12);
  EXPECT_EQ(stored.thumbnails[0], "jpeg");
}

// The same of a file with a camera of every lens there was on 2026-11-25.
TEST(MapFile, ReadsTheFirstVersionWithCameras) {
  const StoredMap stored = load_map(DXSLAM_SOURCE_DIR "/tests/data/map_v1_cameras.dxmap");
  constexpr std::array kLenses{"radtan", "radtan", "rational", "kannala_brandt", "double_sphere"};
  ASSERT_EQ(stored.map.rig().cameras().size(), kLenses.size());
  for (std::size_t id = 0; id < kLenses.size(); ++id) {
    const Camera& camera = stored.map.rig()[static_cast<CameraId>(id)];
    EXPECT_STREQ(camera.lens.model->name, kLenses[id]);
    EXPECT_EQ(camera.lens.parameters[0], id == 0 ? 0.0 : 0.01);
    EXPECT_EQ(camera.readout_time, id == 0 ? 0.0 : 0.02);
    EXPECT_EQ(stored.map.keyframe(static_cast<KeyframeId>(id)).frame->camera, id);
  }
  expect_consistent(stored.map);
}

TEST(MapFile, ListsItsSections) {
  const TestFolder folder;
  save_map(folder / "m", sample_snapshot());
  std::string ids;
  std::size_t size = 32;
  for (const MapFileSection& s : list_map_sections(folder / "m")) {
    ids += s.id + " ";
    size += s.size + 32;
    EXPECT_EQ(s.version, 1U);
  }
  EXPECT_EQ(ids, "HEAD KEYF KEYP GLOB PNTS LOOP THUM ");
  EXPECT_EQ(size, std::filesystem::file_size(folder / "m"));
}

TEST(MapHeader, OfAnotherNetworkIsRefused) {
  const MapHeader map = sample_header();
  MapHeader current = map;
  EXPECT_NO_THROW(require_same_features(map, current, "m.dxmap"));
  current.extractor = "renamed";
  EXPECT_NO_THROW(require_same_features(map, current, "m.dxmap")) << "the same weights";
  current = map;
  current.model_hash = std::string(64, 'b');
  expect_input_error([&] { require_same_features(map, current, "m.dxmap"); },
                     {"m.dxmap: the map was made with features `sample` (32 floats)", "training"});
  current.model_hash.clear();
  EXPECT_NO_THROW(require_same_features(map, current, "m.dxmap")) << "unknown weights";
  expect_input_error([&] { require_same_features(map, sample_header(true), "m"); },
                     {"`sample` (32 floats), in use is `orb` (32 bytes)"});
}

// Every lens, and readings of a camera that the header has no room for.
TEST(MapFile, KeepsAllCameras) {
  const TestFolder folder;
  MapSnapshot snapshot = sample_snapshot();
  for (const LensModel* model : lens_models()) {
    Camera camera = test_camera();
    camera.readout_time = 0.02;
    camera.lens.model = model;
    camera.lens.parameters[0] = 0.01;
    camera.prepare("test");
    const CameraId id = snapshot.parts.rig.add(camera);
    auto frame = std::make_shared<Frame>(*snapshot.parts.keyframes[id].frame);
    frame->camera = id;
    snapshot.parts.keyframes[id].frame = frame;
  }
  save_map(folder / "m", snapshot);
  const Map map = load_map(folder / "m").map;
  EXPECT_EQ(map.rig().cameras(), snapshot.parts.rig.cameras());
  for (KeyframeId id = 1; id <= lens_models().size(); ++id) {
    EXPECT_EQ(map.keyframe(id).frame->camera, id);
  }
  EXPECT_TRUE(map.camera_of(3).contains({300.0, 200.0})) << "it is prepared";
}

TEST(MapFile, OfTooManyCamerasIsNotSavedNorLoaded) {
  const TestFolder folder;
  MapSnapshot snapshot = sample_snapshot();
  for (std::size_t i = 0; i < kMostCameras; ++i) {
    Camera camera = test_camera();
    camera.fx += static_cast<double>(i) + 1.0;
    snapshot.parts.rig.add(camera);
  }
  expect_input_error([&] { save_map(folder / "m", snapshot); }, {"m: ", "too many cameras"});
  const std::string file = unchecked_bytes(snapshot, DescriptorCoding::kInt8);
  expect_input_error([&] { parse_map(file.data(), file.size(), "f"); }, {"f: ", "257 cameras"});
}

TEST(MapFile, RefusesCamerasThatItDoesNotKnow) {
  MapSnapshot snapshot = sample_snapshot();
  auto frame = std::make_shared<Frame>(*snapshot.parts.keyframes[1].frame);
  frame->camera = 1;
  snapshot.parts.keyframes[1].frame = frame;
  const TestFolder folder;
  EXPECT_THROW(save_map(folder / "m", snapshot), ContractError);
  std::string file = unchecked_bytes(snapshot, DescriptorCoding::kInt8);
  expect_input_error([&] { parse_map(file.data(), file.size(), "f"); },
                     {"f: ", "keyframe 1 of camera 1 of 1"});
  SectionWriter newer(1000);
  const LensModel model{"periscope", {}, true, false, nullptr, 0, nullptr, nullptr};
  Camera camera = test_camera();
  camera.lens.model = &model;
  write_header(snapshot.header, Rig(test_camera()), newer);
  write_cameras(Rig(camera), newer);
  write_keyframes(snapshot.parts, newer);
  file = newer.finish();
  expect_input_error([&] { parse_map(file.data(), file.size(), "f"); },
                     {"f: ", "periscope", "a newer dxslam"});
}

}  // namespace
}  // namespace dxslam
