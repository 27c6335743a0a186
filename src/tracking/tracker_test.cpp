// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "tracking/tracker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/error.h"
#include "core/rolling_shutter.h"
#include "map/point_scene.h"

namespace dxslam {
namespace {

// The first keyframe of a map, at the origin; all its keypoints with depth are points.
void start_map(Map& map, const FramePtr& frame, const Camera& camera, Tracker& tracker) {
  map.add_camera(camera);
  const KeyframeId id = map.add_keyframe(frame, SE3(), kNoId);
  for (std::size_t i = 0; i < frame->size(); ++i) {
    if (!frame->has_depth(i)) continue;
    map.add_point(camera.unproject(frame->pixels[i].cast<double>(), frame->depths[i]), id,
                  static_cast<std::uint32_t>(i));
  }
  tracker.set_local_map(make_local_map(map, id, LocalMapOptions()));
}

// A tracker with a map of one keyframe at the origin in which all keypoints with depth are points.
class TrackerTest : public testing::Test {
 protected:
  TrackerTest() : tracker_(scene_.camera(), scene_.traits(), TrackerOptions()) {}

  void start() {
    const FramePtr frame = scene_.frame(0, SE3());
    std::optional<KeyframeRequest> request;
    const TrackedFrame first = tracker_.track(frame, request);
    ASSERT_EQ(first.state, TrackingState::kTracking);
    ASSERT_TRUE(request.has_value());
    EXPECT_EQ(request->reference, kNoId);
    start_map(map_, frame, scene_.camera(), tracker_);
  }

  PointScene scene_;
  Tracker tracker_;
  Map map_;
  std::optional<KeyframeRequest> request_;
};

TEST_F(TrackerTest, FollowsASmoothPath) {
  start();
  for (int i = 1; i <= 20; ++i) {
    const SE3 truth = PointScene::pose(0.01 * i);
    const TrackedFrame tracked = tracker_.track(scene_.frame(i, truth), request_);
    ASSERT_EQ(tracked.state, TrackingState::kTracking) << i;
    EXPECT_LT(translation_distance(tracked.world_from_camera, truth), 0.01) << i;
    EXPECT_LT(rotation_angle(tracked.world_from_camera, truth), 0.005) << i;
    EXPECT_FALSE(tracked.recovered) << i;
    EXPECT_GT(tracked.inliers, 100) << i;
  }
}

TEST_F(TrackerTest, PredictsOverDroppedFrames) {
  start();
  for (const int i : {1, 2, 3, 4, 19, 20}) {
    const SE3 truth = PointScene::pose(0.01 * i);
    const TrackedFrame tracked = tracker_.track(scene_.frame(i, truth), request_);
    ASSERT_EQ(tracked.state, TrackingState::kTracking) << i;
    EXPECT_FALSE(tracked.recovered) << i;
    EXPECT_LT(translation_distance(tracked.world_from_camera, truth), 0.01) << i;
  }
}

TEST_F(TrackerTest, FindsItselfAfterAJumpByDescriptorsAlone) {
  start();
  const SE3 truth = PointScene::pose(0.25);
  const TrackedFrame tracked = tracker_.track(scene_.frame(1, truth), request_);
  ASSERT_EQ(tracked.state, TrackingState::kTracking);
  EXPECT_TRUE(tracked.recovered);
  EXPECT_LT(translation_distance(tracked.world_from_camera, truth), 0.02);
  EXPECT_TRUE(request_.has_value()) << "so far away a keyframe is due";
}

TEST_F(TrackerTest, SaysLostInFrontOfSomethingElseAndRecovers) {
  start();
  PointScene elsewhere(2500, 99);
  const TrackedFrame lost = tracker_.track(elsewhere.frame(1, SE3()), request_);
  EXPECT_EQ(lost.state, TrackingState::kLost);
  EXPECT_FALSE(request_.has_value());
  EXPECT_EQ(tracker_.loss_reason(), LossReason::kFewMatches);
  EXPECT_LT(tracker_.most_matches(), TrackerOptions().min_inliers);
  EXPECT_FALSE(tracker_.covariance());
  const TrackedFrame back = tracker_.track(scene_.frame(2, PointScene::pose(0.05)), request_);
  EXPECT_EQ(back.state, TrackingState::kTracking);
  EXPECT_TRUE(back.recovered);
  EXPECT_TRUE(tracker_.covariance());
}

TEST_F(TrackerTest, SurvivesAFrameWithoutKeypoints) {
  start();
  const auto empty = std::make_shared<Frame>();
  EXPECT_EQ(tracker_.track(empty, request_).state, TrackingState::kLost);
  EXPECT_EQ(tracker_.loss_reason(), LossReason::kFewKeypoints);
  EXPECT_EQ(tracker_.track(scene_.frame(2, SE3()), request_).state, TrackingState::kTracking);
}

TEST_F(TrackerTest, DoesNotStartWithoutDepth) {
  const TrackedFrame tracked = tracker_.track(scene_.frame(0, SE3(), 0.3, 0.0), request_);
  EXPECT_EQ(tracked.state, TrackingState::kNotStarted);
  EXPECT_FALSE(request_.has_value());
  EXPECT_EQ(tracker_.loss_reason(), LossReason::kFewDepths);
}

// Every point is found by its descriptor, but all pixels are somewhere else.
TEST_F(TrackerTest, SaysThatWhatWasFoundAgreesOnNothing) {
  start();
  auto scattered = std::make_shared<Frame>(*scene_.frame(1, SE3()));
  std::mt19937 generator(3);
  std::shuffle(scattered->pixels.begin(), scattered->pixels.end(), generator);
  EXPECT_EQ(tracker_.track(scattered, request_).state, TrackingState::kLost);
  EXPECT_EQ(tracker_.loss_reason(), LossReason::kNoAgreement);
  EXPECT_GE(tracker_.most_matches(), TrackerOptions().min_inliers);
}

TEST_F(TrackerTest, PosesFollowTheKeyframeWhenMappingMovesIt) {
  start();
  tracker_.track(scene_.frame(1, PointScene::pose(0.01)), request_);
  const SE3 shift(Eigen::Quaterniond::Identity(), Eigen::Vector3d(5.0, 0.0, 0.0));
  for (const PointId id : map_.point_ids()) map_.set_position(id, shift * map_.point(id).position);
  map_.set_pose(0, shift);
  tracker_.set_local_map(make_local_map(map_, 0, LocalMapOptions()));
  const SE3 truth = PointScene::pose(0.02);
  const TrackedFrame tracked = tracker_.track(scene_.frame(2, truth), request_);
  ASSERT_EQ(tracked.state, TrackingState::kTracking);
  EXPECT_FALSE(tracked.recovered);
  EXPECT_LT(translation_distance(tracked.world_from_camera, shift * truth), 0.01);
  EXPECT_LT(translation_distance(tracked.reference_from_camera, truth), 0.01);
}

// The reference was culled while its component was joined to another.
TEST_F(TrackerTest, FollowsIntoAnotherWorldWithoutItsReference) {
  start();
  tracker_.track(scene_.frame(1, PointScene::pose(0.01)), request_);
  const SE3 shift(so3_exp({0.0, 0.5, 0.0}), Eigen::Vector3d(5.0, 0.0, 0.0));
  Map joined;
  joined.add_camera(scene_.camera());
  joined.add_keyframe(scene_.frame(7, SE3()), SE3(), kNoId);  // the id that the reference had
  const FramePtr frame = scene_.frame(0, SE3());
  const KeyframeId id = joined.add_keyframe(frame, shift, kNoId);
  for (std::size_t i = 0; i < frame->size(); ++i) {
    if (!frame->has_depth(i)) continue;
    joined.add_point(
        shift * scene_.camera().unproject(frame->pixels[i].cast<double>(), frame->depths[i]), id,
        static_cast<std::uint32_t>(i));
  }
  tracker_.set_local_map(make_local_map(joined, id, LocalMapOptions()));
  for (int i = 2; i < 5; ++i) {
    const SE3 truth = PointScene::pose(0.01 * i);
    const TrackedFrame tracked = tracker_.track(scene_.frame(i, truth), request_);
    ASSERT_EQ(tracked.state, TrackingState::kTracking);
    EXPECT_EQ(tracked.component, 1U);
    EXPECT_LT(translation_distance(tracked.world_from_camera, shift * truth), 0.01);
  }
}

FramePtr at(double stamp, const FramePtr& frame) {
  auto copy = std::make_shared<Frame>(*frame);
  copy->stamp = stamp;
  return copy;
}

TEST_F(TrackerTest, AClockThatJumpsBackIsNotExtrapolated) {
  start();
  for (int i = 1; i <= 5; ++i)
    tracker_.track(scene_.frame(i, PointScene::pose(0.01 * i)), request_);
  // Half a second back, or the same stamp again: the camera itself has gone on.
  for (const double stamp : {5.0 / 30.0 - 0.5, 5.0 / 30.0 - 0.5, 6.0 / 30.0}) {
    const SE3 truth = PointScene::pose(0.06);
    const TrackedFrame tracked = tracker_.track(at(stamp, scene_.frame(6, truth)), request_);
    ASSERT_EQ(tracked.state, TrackingState::kTracking);
    EXPECT_FALSE(tracked.recovered) << stamp;
    EXPECT_LT(translation_distance(tracked.world_from_camera, truth), 0.01) << stamp;
  }
}

// What spoke for a keyframe goes with the request; one that nobody takes must not be the end of it.
TEST_F(TrackerTest, ARequestTakenBackLosesNothing) {
  start();
  for (int i = 1; i <= 3; ++i) tracker_.track(scene_.frame(i, SE3()), request_);
  const FramePtr far = scene_.frame(4, PointScene::pose(0.2));
  tracker_.track(far, request_);
  ASSERT_TRUE(request_.has_value());
  const std::vector<PointCount> counts = request_->counts;
  tracker_.take_back_request();
  tracker_.track(scene_.frame(5, PointScene::pose(0.2)), request_);
  ASSERT_TRUE(request_.has_value());
  std::size_t more = 0;
  for (const PointCount& before : counts) {
    for (const PointCount& now : request_->counts) {
      if (now.point == before.point && now.visible > before.visible) ++more;
    }
  }
  EXPECT_GT(more, 50U);
  EXPECT_GE(request_->counts.size(), counts.size());
}

TEST_F(TrackerTest, ACameraAtRestMakesNoKeyframes) {
  start();
  for (int i = 1; i <= 100; ++i) {
    tracker_.track(scene_.frame(i, SE3()), request_);
    ASSERT_FALSE(request_.has_value()) << i;
  }
}

// Pans to and fro with a camera that reads its rows one after another; the largest error of a
// position when the tracker believes in `readout_time`.
double worst_position(double readout_time) {
  PointScene scene;
  Camera rolling = scene.camera();
  rolling.readout_time = 0.03;
  Camera believed = rolling;
  believed.readout_time = readout_time;
  Tracker tracker(believed, scene.traits(), TrackerOptions());
  Map map;
  std::optional<KeyframeRequest> request;
  double worst = 0.0;
  for (int i = 0; i <= 30; ++i) {
    const double angle = 0.25 * (1.0 - std::cos(0.2 * i));  // up to 86 degrees per second
    Vector6d velocity = Vector6d::Zero();
    velocity(4) = 0.25 * 0.2 * 30.0 * std::sin(0.2 * i);
    const SE3 truth(so3_exp({0.0, angle, 0.0}), Eigen::Vector3d::Zero());
    // Distorted as by the shutter: undone the other way round.
    const FramePtr frame = without_rolling_shutter(scene.frame(i, truth, 0.1), rolling, -velocity);
    const TrackedFrame tracked = tracker.track(frame, request);
    if (tracked.state != TrackingState::kTracking) return 1e9;
    worst = std::max(worst, translation_distance(tracked.world_from_camera, truth));
    if (i == 0) start_map(map, frame, believed, tracker);
  }
  return worst;
}

TEST(Tracker, UndoesTheRollingShutter) {
  const double ignored = worst_position(0.0);
  const double undone = worst_position(0.03);
  EXPECT_GT(ignored, 0.01);
  EXPECT_LT(undone, 0.3 * ignored);
}

std::string refusal(const TrackerOptions& options) {
  const PointScene scene(10);
  try {
    const Tracker tracker(scene.camera(), scene.traits(), options);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(TrackerOptions, NameTheFieldThatIsOutOfRange) {
  TrackerOptions options;
  options.keyframe.max_gap = 0;
  EXPECT_EQ(refusal(options), "option tracking.keyframe.max_gap is 0 frames, expected 1 to 100000");
}

TEST(TrackerOptions, MustFitEachOther) {
  TrackerOptions options;
  options.weak_agreement = options.fair_agreement = options.good_agreement;
  EXPECT_EQ(refusal(options), "");
  options.weak_agreement = 0.5;
  EXPECT_EQ(refusal(options),
            "option tracking.weak_agreement is 0.5, expected at most tracking.fair_agreement, "
            "which is 0.4");
}

}  // namespace
}  // namespace dxslam
