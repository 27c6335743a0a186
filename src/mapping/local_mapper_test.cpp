// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "mapping/local_mapper.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/error.h"
#include "map/point_scene.h"

namespace dxslam {
namespace {

class LocalMapperTest : public testing::Test {
 protected:
  LocalMapperTest() : mapper_(scene_.camera(), scene_.traits(), MappingOptions()) {}

  // A keyframe at `truth`, reported with an error, and without any matches given.
  MappingReport add(int index, const SE3& truth, const Vector6d& error = Vector6d::Zero(),
                    double depth_share = 0.8) {
    KeyframeRequest request;
    request.frame = scene_.frame(index, truth, 0.3, depth_share);
    request.points.assign(request.frame->size(), kNoId);
    if (mapper_.map().keyframe_count() > 0) {
      request.reference = mapper_.map().last_keyframe();
      request.reference_from_camera =
          mapper_.map().keyframe(request.reference).world_from_camera.inverse() *
          (SE3::exp(error) * truth);
    }
    MappingReport report = mapper_.insert(request);
    mapper_.refine(report);
    return report;
  }

  // Of all map points, by the nearest point of the scene, metres.
  double median_position_error() const {
    std::vector<double> errors;
    for (const PointId id : mapper_.map().point_ids()) {
      double nearest = 1e9;
      for (const Eigen::Vector3d& p : scene_.points()) {
        nearest = std::min(nearest, (p - mapper_.map().point(id).position).norm());
      }
      errors.push_back(nearest);
    }
    std::sort(errors.begin(), errors.end());
    return errors[errors.size() / 2];
  }

  PointScene scene_{800};
  LocalMapper mapper_;
};

TEST_F(LocalMapperTest, TheFirstKeyframeMakesPointsFromDepth) {
  const MappingReport report = add(0, SE3());
  EXPECT_GT(report.new_points, 100);
  EXPECT_EQ(mapper_.map().point_count(), static_cast<std::size_t>(report.new_points));
  EXPECT_EQ(mapper_.local_map()->size(), static_cast<std::size_t>(report.new_points));
}

TEST_F(LocalMapperTest, FusesWhatTwoKeyframesSee) {
  const MappingReport first = add(0, SE3());
  const MappingReport second = add(1, PointScene::pose(0.05));
  EXPECT_GT(second.fused_points, first.new_points / 2);
  EXPECT_GT(mapper_.map().best_covisibles(1, 1, 1).front().shared, first.new_points / 2);
  EXPECT_LT(median_position_error(), 0.1);
}

TEST_F(LocalMapperTest, BundleAdjustmentPullsAWrongPoseBack) {
  add(0, SE3());
  add(1, PointScene::pose(0.05));
  add(2, PointScene::pose(0.1));
  Vector6d error;
  error << 0.006, -0.005, 0.006, 0.001, 0.002, -0.001;
  add(3, PointScene::pose(0.15), error);
  const SE3& pose = mapper_.map().keyframe(3).world_from_camera;
  EXPECT_LT(translation_distance(pose, PointScene::pose(0.15)), 0.004);
}

TEST_F(LocalMapperTest, TriangulatesKeypointsWithoutDepth) {
  add(0, SE3(), Vector6d::Zero(), 0.3);
  const MappingReport report = add(1, PointScene::pose(0.1), Vector6d::Zero(), 0.3);
  EXPECT_GT(report.triangulated_points, 10);
  EXPECT_LT(median_position_error(), 0.1);
}

TEST_F(LocalMapperTest, CullsKeyframesThatShowNothingNew) {
  int culled = 0;
  for (int k = 0; k < 12; ++k)
    culled += static_cast<int>(add(k, PointScene::pose(0.005 * k)).culled_keyframes.size());
  EXPECT_GT(culled, 2);
  EXPECT_EQ(mapper_.map().keyframe_count(), static_cast<std::size_t>(12 - culled));
}

TEST_F(LocalMapperTest, KeepsLessOfAnotherVisitOfTheSamePlace) {
  // Back and forth along one path, told or not told that each way is another visit.
  const auto keyframes_after = [&](bool told) {
    mapper_ = LocalMapper(scene_.camera(), scene_.traits(), MappingOptions());
    for (int visit = 0; visit < 4; ++visit) {
      if (told) mapper_.begin_recording();
      for (int k = 0; k < 8; ++k) {
        const int place = visit % 2 == 0 ? k : 7 - k;
        add(8 * visit + k, PointScene::pose(0.4 * place + 0.05 * visit));
      }
    }
    return mapper_.map().keyframe_count();
  };
  const std::size_t once = keyframes_after(false);
  const std::size_t visits = keyframes_after(true);
  EXPECT_LT(visits, once);
  EXPECT_GT(visits, 2U);
  EXPECT_LT(median_position_error(), 0.1);
}

TEST_F(LocalMapperTest, DropsPointsThatAreExpectedButNeverFound) {
  add(0, SE3());
  KeyframeRequest request;
  request.frame = scene_.frame(1, PointScene::pose(0.05));
  request.points.assign(request.frame->size(), kNoId);
  request.reference = 0;
  request.reference_from_camera = PointScene::pose(0.05);
  const std::vector<PointId> ids = mapper_.map().point_ids();
  for (std::size_t i = 0; i < 20; ++i) request.counts.push_back({ids[i], 10, 0});
  const MappingReport report = mapper_.insert(request);
  EXPECT_EQ(report.culled_points, 20);
}

TEST_F(LocalMapperTest, PausesBetweenNeighboursAndBetweenStepsOfTheBundle) {
  int pauses = 0;
  mapper_ = LocalMapper(scene_.camera(), scene_.traits(), MappingOptions(), [&] { ++pauses; });
  add(0, SE3());
  EXPECT_GT(pauses, 0);
  pauses = 0;
  Vector6d step = Vector6d::Zero();
  step(0) = 0.1;
  add(1, SE3::exp(step));
  EXPECT_GT(pauses, 4);  // inserted, fused, and at least two steps
}

TEST_F(LocalMapperTest, IsDeterministic) {
  LocalMapper other(scene_.camera(), scene_.traits(), MappingOptions());
  std::vector<KeyframeRequest> requests;
  for (int k = 0; k < 4; ++k) {
    KeyframeRequest request;
    request.frame = scene_.frame(k, PointScene::pose(0.05 * k));
    request.points.assign(request.frame->size(), kNoId);
    if (k > 0) {
      request.reference = static_cast<KeyframeId>(k - 1);
      request.reference_from_camera =
          PointScene::pose(0.05 * (k - 1)).inverse() * PointScene::pose(0.05 * k);
    }
    for (LocalMapper* mapper : {&mapper_, &other}) {
      MappingReport report = mapper->insert(request);
      mapper->refine(report);
    }
  }
  ASSERT_EQ(mapper_.map().point_ids(), other.map().point_ids());
  for (const PointId id : other.map().point_ids()) {
    ASSERT_EQ(mapper_.map().point(id).position, other.map().point(id).position);
  }
}

}  // namespace
}  // namespace dxslam
