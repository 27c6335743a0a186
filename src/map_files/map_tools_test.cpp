// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors

// What can be done with map files: merging, exports, statistics.
#include <algorithm>
#include <sstream>

#include "io/primitives/test_folder.h"
#include "map_files/map_export.h"
#include "map_files/map_merge.h"
#include "map_files/map_statistics.h"
#include "map_files/test_map_files.h"

namespace dxslam {
namespace {

StoredMap stored_sample(int keyframes, bool binary = false) {
  MapSnapshot s = sample_snapshot(keyframes, binary);
  return {s.header, Map(s.parts), s.loops, s.thumbnails};
}

TEST(MergedMaps, HoldBothSideBySide) {
  const StoredMap a = stored_sample(5);
  const StoredMap b = stored_sample(6);
  const MapSnapshot merged = merge_maps(a, "a", b, "b");
  const Map map(merged.parts);
  expect_consistent(map);
  const auto keyframes = static_cast<KeyframeId>(a.map.keyframe_count());
  const auto points = static_cast<PointId>(a.map.point_count());
  ASSERT_EQ(map.keyframe_count(), keyframes + b.map.keyframe_count());
  ASSERT_EQ(map.point_count(), points + b.map.point_count());
  EXPECT_EQ(map.component_count(), 4U);
  EXPECT_EQ(map.last_keyframe(), b.map.last_keyframe() + keyframes);
  for (const KeyframeId id : b.map.keyframe_ids()) {
    EXPECT_EQ(map.keyframe(id + keyframes).frame, b.map.keyframe(id).frame);
    EXPECT_EQ(map.keyframe(id + keyframes).component, b.map.keyframe(id).component + 2);
  }
  for (const PointId id : b.map.point_ids()) {
    EXPECT_EQ(map.point(id + points).created_by, b.map.point(id).created_by + keyframes);
    EXPECT_EQ(cv::norm(map.descriptor_of(id + points), b.map.descriptor_of(id)), 0.0);
  }
  ASSERT_EQ(merged.loops.size(), 2U);
  EXPECT_EQ(merged.loops[1].a, b.loops[0].a + keyframes);
  ASSERT_EQ(merged.thumbnails.size(), map.keyframe_count());
  EXPECT_EQ(merged.thumbnails[keyframes], "jpeg");
}

TEST(MergedMaps, CanBeJoinedWhereAPlaceIsKnown) {
  const StoredMap a = stored_sample(5);
  Map map(merge_maps(a, "a", a, "b").parts);
  const auto offset = static_cast<KeyframeId>(a.map.keyframe_count());
  map.join_components(1, offset + 1, SE3());
  expect_consistent(map);
  const Map again(take_apart(map));
  EXPECT_EQ(again.component_count(), 3U);
  EXPECT_EQ(again.keyframe(offset).parent, offset + 1);
}

TEST(MergedMaps, OfDifferentFeaturesAreRefused) {
  const StoredMap a = stored_sample(4);
  StoredMap b = stored_sample(4, true);
  expect_input_error([&] { merge_maps(a, "a.dxmap", b, "b.dxmap"); },
                     {"b.dxmap cannot be merged with a.dxmap", "`orb`"});
}

TEST(MergedMaps, KeepTheCamerasOfBoth) {
  const StoredMap a = stored_sample(4);
  MapSnapshot other = sample_snapshot(4);
  Camera camera = test_camera();
  camera.cx += 5.0;
  other.parts.rig = Rig(camera);
  const StoredMap b{other.header, Map(other.parts), {}, {}};
  const Map map(merge_maps(a, "a.dxmap", b, "b.dxmap").parts);
  const auto half = static_cast<KeyframeId>(map.keyframe_count() / 2);
  EXPECT_EQ(map.camera_of(half - 1), test_camera());
  EXPECT_EQ(map.camera_of(half), camera);
  const Map same(merge_maps(a, "a.dxmap", a, "a.dxmap").parts);
  EXPECT_EQ(same.rig().size(), 1U);
}

std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line[0] != '#') lines.push_back(line);
  }
  return lines;
}

// Reads COLMAP's files by their definition and projects every point into every image of its track.
double worst_colmap_error(const std::vector<std::string>& images,
                          const std::vector<std::string>& points, const Camera& camera) {
  double worst = 0.0;
  for (const std::string& line : points) {
    std::istringstream in(line);
    long id = 0;
    Eigen::Vector3d position;
    int red = 0, green = 0, blue = 0;
    double error = 0.0;
    in >> id >> position.x() >> position.y() >> position.z() >> red >> green >> blue >> error;
    long image = 0;
    for (std::size_t keypoint = 0; in >> image >> keypoint;) {
      const auto it = std::find_if(images.begin(), images.end(), [&](const std::string& text) {
        return text.rfind(std::to_string(image) + " ", 0) == 0 &&
               text.find(".png") != std::string::npos;
      });
      std::istringstream pose(*it);
      std::istringstream keypoints(*(it + 1));
      Eigen::Quaterniond q;
      Eigen::Vector3d t;
      pose >> image >> q.w() >> q.x() >> q.y() >> q.z() >> t.x() >> t.y() >> t.z();
      double x = 0.0, y = 0.0;
      long seen = 0;
      for (std::size_t i = 0; i <= keypoint; ++i) keypoints >> x >> y >> seen;
      EXPECT_EQ(seen, id);
      const Eigen::Vector2d expected = camera.distort(camera.project(q * position + t));
      worst =
          std::max(worst, (expected + Eigen::Vector2d(0.5, 0.5) - Eigen::Vector2d(x, y)).norm());
    }
  }
  return worst;
}

TEST(ColmapExport, IsAModelForEachComponent) {
  for (const double k1 : {0.0, 0.05}) {
    const TestFolder folder;
    MapSnapshot snapshot = sample_snapshot(5);
    Camera camera = test_camera();
    camera.lens.parameters[0] = k1;
    snapshot.parts.rig = Rig(camera);
    const StoredMap stored{snapshot.header, Map(snapshot.parts), {}, {}};
    write_map_colmap(folder.path(), stored);
    const std::vector<std::string> cameras = lines_of(folder.read("0/cameras.txt"));
    ASSERT_EQ(cameras.size(), 1U);
    EXPECT_EQ(cameras[0], k1 == 0.0 ? "1 PINHOLE 640 480 525 520 320 240"
                                    : "1 FULL_OPENCV 640 480 525 520 320 240 0.05 0 0 0 0 0 0 0");
    std::size_t keyframes = 0;
    std::size_t points = 0;
    for (const std::string model : {"0", "1"}) {
      const std::vector<std::string> images = lines_of(folder.read(model + "/images.txt"));
      const std::vector<std::string> tracks = lines_of(folder.read(model + "/points3D.txt"));
      EXPECT_LT(worst_colmap_error(images, tracks, camera), 2.0);
      keyframes += images.size() / 2;
      points += tracks.size();
    }
    EXPECT_EQ(keyframes, stored.map.keyframe_count());
    EXPECT_EQ(points, stored.map.point_count());
    EXPECT_THAT(folder.read("0/images.txt"), testing::HasSubstr(" 1 0.000000.png\n"));
  }
}

TEST(ColmapExport, GivesImagesOfOneStampDifferentNames) {
  const TestFolder folder;
  Map map;
  map.add_camera(test_camera());
  for (int i = 0; i < 2; ++i) {
    map.add_keyframe(std::make_shared<Frame>(), SE3(), i == 0 ? kNoId : 0);
  }
  write_map_colmap(folder.path(), {sample_header(), std::move(map), {}, {}});
  EXPECT_THAT(folder.read("0/images.txt"), testing::HasSubstr(" 0.000000_1.png\n"));
  expect_input_error([&] { write_map_colmap("/dev/null/x", stored_sample(4)); },
                     {"/dev/null/x", "cannot be made"});
}

TEST(PlyExport, TakesAllOrOneComponent) {
  const TestFolder folder;
  const StoredMap stored = stored_sample(5);
  const MapStatistics statistics = map_statistics(stored);
  const auto expect_vertices = [&](std::uint32_t component, std::size_t count) {
    write_map_ply(folder / "m.ply", stored.map, component);
    EXPECT_THAT(folder.read("m.ply"),
                testing::HasSubstr("element vertex " + std::to_string(count) + "\n"));
  };
  expect_vertices(kNoId, stored.map.point_count() + stored.map.keyframe_count());
  for (std::uint32_t i = 0; i < 2; ++i) {
    expect_vertices(i, statistics.components[i].points + statistics.components[i].keyframes);
  }
}

TEST(MapStatistics, CountsAndMeasures) {
  StoredMap stored = stored_sample(5);
  const MapStatistics s = map_statistics(stored);
  ASSERT_EQ(s.components.size(), 2U);
  EXPECT_EQ(s.components[0].keyframes, 4U);
  EXPECT_EQ(s.components[1].keyframes, 2U);
  EXPECT_EQ(s.components[0].points + s.components[1].points, stored.map.point_count());
  EXPECT_EQ(s.components[0].last_stamp, 4.0 / 30.0);
  EXPECT_NEAR(s.components[0].extent,
              translation_distance(PointScene::pose(0), PointScene::pose(0.32)), 0.01);
  EXPECT_EQ(s.globals, 5U);
  EXPECT_EQ(s.covisible_groups, 2U);
  EXPECT_EQ(s.blind_keyframes, 0U);
  EXPECT_EQ(s.behind, 0U);
  EXPECT_GT(s.median_error, 0.05);
  EXPECT_LT(s.median_error, 0.6);
  EXPECT_GT(s.p95_error, s.median_error);

  stored.map.set_position(0, stored.map.point(0).position - Eigen::Vector3d(0, 0, 50));
  stored.map.add_keyframe(std::make_shared<Frame>(), SE3(), 0);
  const MapStatistics worse = map_statistics(stored);
  EXPECT_EQ(worse.behind, stored.map.point(0).observations.size());
  EXPECT_EQ(worse.blind_keyframes, 1U);
  EXPECT_EQ(worse.covisible_groups, 3U);
}

}  // namespace
}  // namespace dxslam
