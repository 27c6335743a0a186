// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "tracking/frame_matches.h"

#include <gtest/gtest.h>

#include "map/point_scene.h"

namespace dxslam {
namespace {

TEST(FrameMatches, CountsThePointsNearTheirKeypoints) {
  PointScene scene;
  const Camera& camera = scene.camera();
  const FramePtr frame = scene.frame(0, SE3());
  std::vector<KnownPoint> known;
  for (std::size_t i = 0; i < frame->size() && known.size() < 4; ++i) {
    if (!frame->has_depth(i)) continue;
    const Eigen::Vector3d p =
        camera.unproject(frame->pixels[i].cast<double>(), static_cast<double>(frame->depths[i]));
    known.push_back({static_cast<int>(i), kNoId, p});
  }
  ASSERT_EQ(known.size(), 4U);
  const auto shift = [&](KnownPoint& k, double pixels) {
    k.position.x() += pixels / camera.fx * k.position.z();
  };
  shift(known[1], 2.9);
  shift(known[2], 3.1);
  known[3].position.z() *= -1.0;  // behind the camera
  EXPECT_EQ(count_near(camera, *frame, SE3(), known, 3.0), 2);
  EXPECT_EQ(count_near(camera, *frame, SE3(), known, 4.0), 3);
  EXPECT_EQ(count_near(camera, *frame, SE3(), {}, 4.0), 0);
  EXPECT_EQ(count_in_view(camera, SE3(), known), 3);
  known[0].position.x() = 100.0;  // beside the image
  EXPECT_EQ(count_in_view(camera, SE3(), known), 2);
}

}  // namespace
}  // namespace dxslam
