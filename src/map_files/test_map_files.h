// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

// For tests only: small maps with everything a file can hold, and whether two maps are the same.

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "map/test_map.h"
#include "map_files/map_file.h"

namespace dxslam {

/// The camera and descriptors of PointScene with made-up global descriptors; or 32 bytes per
/// keypoint and no global descriptor.
inline MapHeader sample_header(bool binary = false) {
  MapHeader header;
  header.extractor = binary ? "orb" : "sample";
  header.model_hash = binary ? "" : std::string(64, 'a');
  header.traits =
      binary ? DescriptorTraits{true, 32, 60.0F, 0} : DescriptorTraits{false, 32, 0.6F, 16};
  return header;
}

inline FramePtr sample_frame(const FramePtr& from, bool binary) {
  auto frame = std::make_shared<Frame>(*from);
  if (binary) {
    from->descriptors.convertTo(frame->descriptors, CV_8U, 300.0, 128.0);
  } else if (from->index % 5 != 4) {
    frame->global.assign(16, 0.0F);
    frame->global[static_cast<std::size_t>(from->index) % 16] = 0.8F;
    frame->global[static_cast<std::size_t>(from->index + 3) % 16] = -0.6F;
  }
  return frame;
}

/// A map of `keyframes` (at least 4), one of which was removed, and a second component of two.
inline Map sample_map(int keyframes, bool binary = false, int points = 60) {
  PointScene scene(points);
  Map map;
  map.add_camera(scene.camera());
  const auto add = [&](int k, KeyframeId parent) {
    std::vector<int> source;
    const SE3 pose = PointScene::pose(0.08 * k);
    const KeyframeId id = map.add_keyframe(
        sample_frame(scene.frame(k, pose, 0.3, 0.8, &source), binary), pose, parent);
    // The points of the scene that an earlier keyframe of the component has are seen again.
    for (std::size_t i = 0; i < source.size(); ++i) {
      const auto keypoint = static_cast<std::uint32_t>(i);
      const Eigen::Vector3d& position = scene.points()[static_cast<std::size_t>(source[i])];
      bool seen = false;
      for (const PointId p : map.point_ids()) {
        const MapPoint& point = map.point(p);
        const auto component = map.keyframe(point.observations.front().keyframe).component;
        if (point.position != position || component != map.keyframe(id).component) continue;
        seen = map.add_observation(p, id, keypoint);
      }
      if (!seen && i % 7 != 0) map.add_point(position, id, keypoint);
    }
    return id;
  };
  KeyframeId last = kNoId;
  for (int k = 0; k < keyframes; ++k) last = add(k, last);
  add(keyframes + 1, add(keyframes, kNoId));
  map.remove_keyframe(2);
  for (const PointId id : map.point_ids()) {
    map.count_visible(id, 3, 2);
    map.refresh_point(id);
  }
  return map;
}

inline MapSnapshot sample_snapshot(int keyframes = 5, bool binary = false, int points = 60) {
  const SE3 a_from_b(so3_exp({0.1, -0.2, 0.3}), {0.5, -0.25, 2.0});
  return take_snapshot(sample_header(binary), sample_map(keyframes, binary, points),
                       {{0, 3, a_from_b}}, {"jpeg", "", "gone", "more jpeg"});
}

/// All of two maps but the descriptors, which a file holds less exactly; the poses but for the last
/// bit.
inline void expect_same_maps(const Map& a, const Map& b) {
  ASSERT_EQ(a.keyframe_count(), b.keyframe_count());
  ASSERT_EQ(a.point_count(), b.point_count());
  EXPECT_EQ(a.last_keyframe(), b.last_keyframe());
  EXPECT_EQ(a.component_count(), b.component_count());
  for (const KeyframeId id : a.keyframe_ids()) {
    const Keyframe& x = a.keyframe(id);
    const Keyframe& y = b.keyframe(id);
    EXPECT_LT((x.world_from_camera.matrix() - y.world_from_camera.matrix()).norm(), 1e-14);
    EXPECT_EQ(x.parent, y.parent);
    EXPECT_EQ(x.component, y.component);
    EXPECT_EQ(x.points, y.points);
    ASSERT_EQ(x.covisibles.size(), y.covisibles.size());
    for (std::size_t i = 0; i < x.covisibles.size(); ++i) {
      EXPECT_EQ(x.covisibles[i].keyframe, y.covisibles[i].keyframe);
      EXPECT_EQ(x.covisibles[i].shared, y.covisibles[i].shared);
    }
    EXPECT_EQ(x.frame->index, y.frame->index);
    EXPECT_EQ(x.frame->stamp, y.frame->stamp);
    EXPECT_EQ(x.frame->pixels, y.frame->pixels);
    EXPECT_EQ(x.frame->depths, y.frame->depths);
    EXPECT_EQ(x.frame->scores, y.frame->scores);
    EXPECT_EQ(x.frame->sigmas, y.frame->sigmas);
    EXPECT_EQ(x.frame->global.size(), y.frame->global.size());
    EXPECT_EQ(x.frame->descriptors.type(), y.frame->descriptors.type());
    EXPECT_EQ(x.frame->descriptors.size(), y.frame->descriptors.size());
  }
  for (const PointId id : a.point_ids()) {
    const MapPoint& x = a.point(id);
    const MapPoint& y = b.point(id);
    EXPECT_EQ(x.position, y.position);
    EXPECT_EQ(x.normal, y.normal);
    EXPECT_EQ(x.distance, y.distance);
    EXPECT_EQ(x.created_by, y.created_by);
    EXPECT_EQ(x.visible, y.visible);
    EXPECT_EQ(x.found, y.found);
    EXPECT_EQ(x.descriptor, y.descriptor);
    ASSERT_EQ(x.observations.size(), y.observations.size());
    for (std::size_t i = 0; i < x.observations.size(); ++i) {
      EXPECT_EQ(x.observations[i].keyframe, y.observations[i].keyframe);
      EXPECT_EQ(x.observations[i].keypoint, y.observations[i].keypoint);
    }
  }
}

/// Largest difference of any number of any descriptor, global ones included.
inline double descriptor_difference(const Map& a, const Map& b) {
  double largest = 0.0;
  for (const KeyframeId id : a.keyframe_ids()) {
    const Frame& x = *a.keyframe(id).frame;
    const Frame& y = *b.keyframe(id).frame;
    largest = std::max(largest, cv::norm(x.descriptors, y.descriptors, cv::NORM_INF));
    if (!x.global.empty()) largest = std::max(largest, cv::norm(x.global, y.global, cv::NORM_INF));
  }
  return largest;
}

}  // namespace dxslam
