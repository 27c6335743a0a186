// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "slam/observer.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <atomic>
#include <cstring>
#include <map>
#include <memory>
#include <thread>
#include <vector>

#include "map/map_parts.h"
#include "slam/system.h"
#include "slam/test_recording.h"

namespace dxslam {
namespace {

SystemOptions options_of(bool deterministic) {
  SystemOptions options;
  options.deterministic = deterministic;
  options.features = "recording";
  options.loop_detection.max_distance_global = 0.2;
  return options;
}

std::unique_ptr<System> make_system(bool deterministic, int broken_global = -1) {
  return std::make_unique<System>(recording().camera(),
                                  std::make_unique<RecordingExtractor>(-1, broken_global),
                                  options_of(deterministic));
}

RgbdImage image_of(int index) { return recording().images()[static_cast<std::size_t>(index)]; }

// What a reader of the stream knows of the map.
class Mirror {
 public:
  void apply(const MapChanged& change) {
    for (const KeyframeId id : change.removed_keyframes) ASSERT_EQ(keyframes_.erase(id), 1U);
    for (const PointId id : change.removed_points) ASSERT_EQ(points_.erase(id), 1U);
    for (const KeyframePose& k : change.added_keyframes) {
      ASSERT_TRUE(keyframes_.emplace(k.id, k).second);
    }
    for (const PointPosition& p : change.added_points) {
      ASSERT_TRUE(points_.emplace(p.id, p.position).second);
    }
    for (const KeyframePose& k : change.moved_keyframes) keyframes_.at(k.id) = k;
    for (const PointPosition& p : change.moved_points) points_.at(p.id) = p.position;
  }
  /// Skips what is in `since` already.
  void follow(const std::vector<MessagePtr>& messages, std::uint64_t since = 0) {
    for (const MessagePtr& m : messages) {
      const auto* change = std::get_if<MapChanged>(&m->event);
      if (change != nullptr && m->map_version > since) apply(*change);
    }
  }
  void expect_same(const Map& map) const {
    ASSERT_EQ(keyframes_.size(), map.keyframe_count());
    ASSERT_EQ(points_.size(), map.point_count());
    for (const auto& [id, k] : keyframes_) {
      EXPECT_EQ(k.world_from_camera.matrix(), map.keyframe(id).world_from_camera.matrix()) << id;
      EXPECT_EQ(k.component, map.keyframe(id).component);
      EXPECT_EQ(k.stamp, map.keyframe(id).frame->stamp);
    }
    for (const auto& [id, position] : points_) EXPECT_EQ(position, map.point(id).position) << id;
  }

 private:
  std::map<KeyframeId, KeyframePose> keyframes_;
  std::map<PointId, Eigen::Vector3d> points_;
};

std::vector<MessagePtr> read_all(Subscription& reader) {
  std::vector<MessagePtr> messages;
  while (MessagePtr m = reader.try_next()) messages.push_back(std::move(m));
  return messages;
}

template <class Wanted>
std::vector<Wanted> only(const std::vector<MessagePtr>& messages) {
  std::vector<Wanted> found;
  for (const MessagePtr& m : messages) {
    if (const auto* event = std::get_if<Wanted>(&m->event)) found.push_back(*event);
  }
  return found;
}

TEST(Observer, ChangesAddUpToTheMap) {
  for (const bool deterministic : {true, false}) {
    const auto system = make_system(deterministic);
    const SubscriptionPtr reader = system->subscribe(100000);
    for (int i = 0; i < kFrames; ++i) system->process(image_of(i));
    system->finish();
    const std::vector<MessagePtr> messages = read_all(*reader);
    EXPECT_EQ(reader->lost(), 0U);
    EXPECT_TRUE(reader->has_ended());
    Mirror mirror;
    mirror.follow(messages);
    mirror.expect_same(system->map());
    std::uint64_t version = 0;
    for (std::size_t i = 0; i < messages.size(); ++i) {
      EXPECT_EQ(messages[i]->number, messages.front()->number + i);
      EXPECT_GE(messages[i]->map_version, version);
      version = messages[i]->map_version;
    }
    EXPECT_EQ(only<FrameTracked>(messages).size(), static_cast<std::size_t>(kFrames));
  }
}

TEST(Observer, WhoComesLateBeginsWithTheWholeMap) {
  const auto system = make_system(false);
  for (int i = 0; i < kFrames / 2; ++i) system->process(image_of(i));
  const SubscriptionPtr reader = system->subscribe(100000);
  const WholeMap whole = system->whole_map().value();
  for (int i = kFrames / 2; i < kFrames; ++i) system->process(image_of(i));
  system->finish();
  Mirror mirror;
  mirror.apply(whole.map);
  mirror.follow(read_all(*reader), whole.map_version);
  mirror.expect_same(system->map());
}

TEST(Observer, ALoadedMapIsAddedAtOnce) {
  const auto first = make_system(true);
  for (int i = 0; i < kFrames; ++i) first->process(image_of(i));
  first->finish();
  const auto system = make_system(true);
  const SubscriptionPtr reader = system->subscribe(100000);
  system->load_map(Map(take_apart(first->map())), {});
  for (int i = 20; i < kFrames; ++i) system->process(image_of(i));
  system->finish();
  Mirror mirror;
  mirror.follow(read_all(*reader));
  mirror.expect_same(system->map());
}

// Readers ask at any time, that of the end included.
TEST(Observer, TheWholeMapIsToBeHadWhileTheRunEnds) {
  const auto system = make_system(false);
  const SubscriptionPtr reader = system->subscribe(16);
  std::atomic<bool> ended{false};
  std::thread asking([&] {
    while (!ended) {
      if (!system->whole_map()) ADD_FAILURE() << "the map is whole";
    }
  });
  for (int i = 0; i < kFrames; ++i) system->process(image_of(i));
  system->finish();
  ended = true;
  asking.join();
  EXPECT_EQ(system->whole_map()->map.added_keyframes.size(), system->map().keyframe_count());
}

TEST(Observer, TellsOfLossPlaceAndRecordings) {
  const auto system = make_system(true);
  const SubscriptionPtr reader = system->subscribe(100000);
  for (int i = 0; i < kFrames; ++i) system->process(image_of(i));
  RgbdImage blind = image_of(0);
  const std::int32_t nothing = -1;
  blind.color = blind.color.clone();
  std::memcpy(blind.color.data, &nothing, sizeof(nothing));
  for (int i = 0; i < 3; ++i) {
    blind.stamp = 100.0 + i;
    system->process(blind);
  }
  RgbdImage again = image_of(kFrames / 2);
  again.stamp = 200.0;
  system->process(again);
  system->begin_sequence();
  again.stamp = 300.0;
  system->process(again);
  system->finish();
  const std::vector<MessagePtr> messages = read_all(*reader);
  const auto lost = only<TrackingLost>(messages);
  ASSERT_EQ(lost.size(), 1U);
  EXPECT_EQ(lost[0].stamp, 100.0);
  EXPECT_EQ(lost[0].reason, LossReason::kFewKeypoints);
  EXPECT_EQ(lost[0].keypoints, 0);
  const auto places = only<PlaceFound>(messages);
  ASSERT_FALSE(places.empty());
  EXPECT_GT(places.back().confidence, 0.5);
  const auto begun = only<RecordingBegun>(messages);
  ASSERT_EQ(begun.size(), 2U);
  EXPECT_EQ(begun[0].number, 0);
  EXPECT_EQ(begun[1].number, 1);
  EXPECT_TRUE(std::holds_alternative<RecordingBegun>(messages.front()->event));
  EXPECT_EQ(only<RecordingEnded>(messages).size(), 2U);
  EXPECT_TRUE(std::holds_alternative<RunFinished>(messages.back()->event));
  for (const MapChanged& change : only<MapChanged>(messages)) {
    EXPECT_TRUE(!change.is_correction || !change.moved_keyframes.empty() ||
                !change.moved_points.empty());
  }
  EXPECT_EQ(only<FrameTracked>(messages).back().frame.stamp, 300.0);
}

// What it is lost in front of makes the difference.
TEST(Observer, TellsWhyItIsLost) {
  SystemOptions options = options_of(true);
  options.mode = "localization";
  System system(recording().camera(), std::make_unique<RecordingExtractor>(), options);
  const auto first = make_system(true);
  for (int i = 0; i < kFrames; ++i) first->process(image_of(i));
  first->finish();
  system.load_map(Map(take_apart(first->map())), {});
  const SubscriptionPtr reader = system.subscribe(100, EventKinds::of<TrackingLost>());
  RgbdImage blind = image_of(0);
  const std::int32_t nothing = -1;
  blind.color = blind.color.clone();
  std::memcpy(blind.color.data, &nothing, sizeof(nothing));
  system.process(blind);
  blind.stamp += 1.0;
  system.process(blind);  // lost still: nothing new
  RgbdImage seen = image_of(20);
  seen.stamp = 10.0;
  system.process(seen);
  system.finish();
  const auto lost = only<TrackingLost>(read_all(*reader));
  ASSERT_EQ(lost.size(), 1U);
  EXPECT_EQ(lost[0].reason, LossReason::kFewKeypoints);
  EXPECT_STREQ(describe(lost[0].reason), "too few keypoints");
}

// Both recordings in one world in the end, whose second began as its own.
TEST(Observer, TellsOfLoopsFoundAndMapsJoined) {
  SystemOptions options = options_of(true);
  options.new_map_after = 3;
  options.relocalization.acceptance.min_inliers = 100000;  // never satisfied
  options.relocalization.consensus.min_inliers = 100000;
  System system(recording().camera(), std::make_unique<RecordingExtractor>(), options);
  const SubscriptionPtr reader = system.subscribe(100000);
  for (int i = 0; i < 30; ++i) system.process(image_of(i));
  system.begin_sequence();
  for (int i = 0; i < kFrames; ++i) {
    RgbdImage image = image_of(i);
    image.stamp += 100.0;
    system.process(image);
  }
  system.finish();
  const std::vector<MessagePtr> messages = read_all(*reader);
  const auto joined = only<MapsJoined>(messages);
  ASSERT_EQ(joined.size(), 1U);
  EXPECT_EQ(joined[0].kept_component, 0U);
  EXPECT_EQ(joined[0].joined_component, 1U);
  const auto lost = only<TrackingLost>(messages);
  ASSERT_FALSE(lost.empty());
  EXPECT_EQ(lost[0].reason, LossReason::kPlaceUnknown);
  EXPECT_EQ(only<LoopFound>(messages).size(),
            only<LoopRefused>(messages).size() + only<LoopClosed>(messages).size() + joined.size());
  for (std::size_t i = 0; i < messages.size(); ++i) {
    if (!std::holds_alternative<MapsJoined>(messages[i]->event)) continue;
    EXPECT_TRUE(std::holds_alternative<LoopFound>(messages[i - 1]->event));
    const auto* change = std::get_if<MapChanged>(&messages[i + 1]->event);
    ASSERT_NE(change, nullptr);
    EXPECT_TRUE(change->is_correction);
  }
  for (const KeyframeMapped& mapped : only<KeyframeMapped>(messages)) {
    EXPECT_GT(mapped.insert_ms, 0.0);
    EXPECT_NE(mapped.report.keyframe, kNoId);
  }
}

// Poses follow the map: those of a version are what the keyframes of that version say.
TEST(Observer, AllPosesOfAVersionAreToBeHadAtAnyTime) {
  const auto system = make_system(false);
  std::atomic<bool> ended{false};
  std::thread asking([&] {
    std::uint64_t version = 0;
    std::size_t frames = 0;
    while (!ended) {
      const auto poses = system->all_poses();
      if (!poses) return ADD_FAILURE() << "the map is whole";
      EXPECT_GE(poses->map_version, version);
      EXPECT_GE(poses->frames.size(), frames);
      version = poses->map_version;
      frames = poses->frames.size();
    }
  });
  for (int i = 0; i < kFrames; ++i) system->process(image_of(i));
  system->finish();
  ended = true;
  asking.join();
  const AllPoses poses = system->all_poses().value();
  const Trajectory trajectory = system->trajectory();
  EXPECT_EQ(poses.map_version, system->events().map_version());
  ASSERT_EQ(poses.frames.size(), trajectory.size());
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    EXPECT_EQ(poses.frames[i].stamp, trajectory[i].stamp);
    EXPECT_EQ(poses.frames[i].component, 0U);
    EXPECT_EQ(poses.frames[i].world_from_camera.matrix(), trajectory[i].world_from_camera.matrix());
  }
}

// The squared error over its covariance has a mean of 6, one per direction, where that is right.
// The map is made of noisy images too, which the covariance leaves out, so that it is larger: 3.7
// here.
TEST(Observer, TheCovarianceOfAPoseFitsItsError) {
  const auto system = make_system(true);
  const SubscriptionPtr reader =
      system->subscribe(Subscription::kUnbounded, EventKinds::of<FrameTracked>());
  for (int i = 0; i < kFrames; ++i) system->process(image_of(i));
  system->finish();
  double sum = 0.0;
  int count = 0;
  for (const FrameTracked& tracked : only<FrameTracked>(read_all(*reader))) {
    if (tracked.frame.index == 0) {
      EXPECT_FALSE(tracked.covariance);  // the origin by definition
      continue;
    }
    ASSERT_TRUE(tracked.covariance);
    const Matrix6d& covariance = *tracked.covariance;
    EXPECT_EQ(covariance, covariance.transpose());
    const Eigen::LLT<Matrix6d> factors(covariance);
    ASSERT_EQ(factors.info(), Eigen::Success);
    const SE3 truth = PointScene::pose(place(static_cast<int>(tracked.frame.index)));
    const Vector6d error = (tracked.frame.world_from_camera.inverse() * truth).log();
    sum += error.dot(factors.solve(error));
    ++count;
  }
  ASSERT_EQ(count, kFrames - 1);
  const double normalised = sum / count / 6.0;
  EXPECT_GT(normalised, 0.3);
  EXPECT_LT(normalised, 10.0);
}

// Equal input gives equal output, whoever listens, and however slowly.
TEST(Observer, AStuckReaderChangesNothing) {
  const auto alone = make_system(true);
  const auto watched = make_system(true);
  const SubscriptionPtr stuck = watched->subscribe(1);
  for (int i = 0; i < kFrames; ++i) {
    alone->process(image_of(i));
    watched->process(image_of(i));
  }
  alone->finish();
  watched->finish();
  EXPECT_GT(stuck->lost(), static_cast<std::uint64_t>(kFrames));
  const Trajectory a = alone->trajectory();
  const Trajectory b = watched->trajectory();
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].world_from_camera.matrix(), b[i].world_from_camera.matrix());
  }
}

TEST(Observer, AnErrorInsideIsTheLastMessage) {
  const auto system = make_system(false, 1);
  const SubscriptionPtr reader = system->subscribe(100000);
  EXPECT_ANY_THROW({
    for (int i = 0; i < kFrames; ++i) system->process(image_of(i));
    system->finish();
  });
  EXPECT_ANY_THROW(system->finish());
  const std::vector<MessagePtr> messages = read_all(*reader);
  ASSERT_FALSE(messages.empty());
  const auto* failed = std::get_if<RunFailed>(&messages.back()->event);
  ASSERT_NE(failed, nullptr);
  EXPECT_EQ(failed->what, "broken encoder");
  EXPECT_TRUE(reader->has_ended());
}

}  // namespace
}  // namespace dxslam
