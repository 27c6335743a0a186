// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "slam/system.h"

#include <gtest/gtest.h>

#include <cstring>

#include "core/error.h"
#include "map/map_parts.h"
#include "slam/test_recording.h"

namespace dxslam {
namespace {

SystemOptions deterministic() {
  SystemOptions options;
  options.features = "recording";
  options.deterministic = true;
  options.loop_detection.max_distance_global = 0.2;
  return options;
}

std::unique_ptr<System> make_system(const SystemOptions& options) {
  return std::make_unique<System>(recording().camera(), std::make_unique<RecordingExtractor>(),
                                  options);
}

// The images of the recording from `first` on, with later stamps where it is not the first round.
void feed(System& system, int first, int last, double later = 0.0) {
  for (int i = first; i < last; ++i) {
    RgbdImage image = recording().images()[static_cast<std::size_t>(i)];
    image.stamp += later;
    system.process(image);
  }
}

// A map of the whole recording.
Map known_map() {
  const auto system = make_system(deterministic());
  feed(*system, 0, kFrames);
  system->finish();
  return Map(take_apart(system->map()));
}

// Largest distance to the true path.
double worst_error(const Trajectory& trajectory, double later = 0.0) {
  double worst = 0.0;
  for (const StampedPose& pose : trajectory) {
    const int index = static_cast<int>(std::lround(30.0 * (pose.stamp - later)));
    worst = std::max(worst,
                     translation_distance(pose.world_from_camera, PointScene::pose(place(index))));
  }
  return worst;
}

TEST(System, LocalizesInALoadedMapAndLeavesItAsItIs) {
  SystemOptions options = deterministic();
  options.mode = "localization";
  const auto system = make_system(options);
  Map map = known_map();
  const std::size_t keyframes = map.keyframe_count();
  const std::size_t points = map.point_count();
  system->load_map(std::move(map), {});
  feed(*system, 17, kFrames, 100.0);
  system->finish();
  const Trajectory trajectory = system->trajectory();
  EXPECT_EQ(trajectory.size(), static_cast<std::size_t>(kFrames - 17));
  EXPECT_LT(worst_error(trajectory, 100.0), 0.02);
  EXPECT_EQ(system->map().keyframe_count(), keyframes);
  EXPECT_EQ(system->map().point_count(), points);
}

TEST(System, GoesOnWithALoadedMap) {
  const auto system = make_system(deterministic());
  Map map = known_map();
  const std::size_t keyframes = map.keyframe_count();
  system->load_map(std::move(map), {});
  feed(*system, 20, kFrames, 100.0);
  system->finish();
  EXPECT_EQ(system->components().size(), 1U);
  EXPECT_EQ(system->trajectory().size(), static_cast<std::size_t>(kFrames - 20));
  EXPECT_LT(worst_error(system->trajectory(), 100.0), 0.02);
  // What is known already is not mapped a second time.
  EXPECT_LT(system->map().keyframe_count(), 2 * keyframes);
}

TEST(System, SwitchesBetweenLocalizationAndMapping) {
  SystemOptions options = deterministic();
  options.mode = "localization";
  const auto first = make_system(deterministic());
  feed(*first, 0, 15);
  first->finish();
  const auto system = make_system(options);
  const std::size_t known = first->map().keyframe_count();
  system->load_map(Map(take_apart(first->map())), {});
  feed(*system, 0, 12, 100.0);
  EXPECT_EQ(system->map().keyframe_count(), known);
  system->set_mapping(true);
  feed(*system, 12, kFrames, 100.0);
  system->finish();
  EXPECT_GT(system->map().keyframe_count(), known);
  EXPECT_EQ(system->trajectory().size(), static_cast<std::size_t>(kFrames));
  EXPECT_LT(worst_error(system->trajectory(), 100.0), 0.02);
}

TEST(System, LocalizationNeedsAMap) {
  SystemOptions options = deterministic();
  options.mode = "localization";
  const auto system = make_system(options);
  EXPECT_THROW(feed(*system, 0, 1), InputError);
  options.mode = "both";
  EXPECT_THROW(make_system(options), InputError);
  for (const char* method : {"hf-bow-global+geometry", "nonsense"}) {
    options = SystemOptions();
    options.loop_detection.method = method;
    EXPECT_THROW(make_system(options), InputError) << method;
  }
}

TEST(System, LocalizesInTheMapThatItMadeItself) {
  const auto system = make_system(deterministic());
  feed(*system, 0, 15);
  const std::size_t made = system->map().keyframe_count();
  system->set_mapping(false);
  feed(*system, 15, 25);
  EXPECT_EQ(system->map().keyframe_count(), made);
  system->begin_sequence();
  feed(*system, 0, 15, 100.0);  // found again, too
  system->finish();
  EXPECT_EQ(system->map().keyframe_count(), made);
  EXPECT_GT(system->trajectory().size(), 30U);
}

TEST(System, LocalizationBeginsNoMap) {
  const auto system = make_system(deterministic());
  RgbdImage covered = recording().images()[0];
  covered.color = covered.color.clone();
  std::memset(covered.color.data, 0xFF, sizeof(std::int32_t));
  system->process(covered);  // there is no map after it
  system->set_mapping(false);
  feed(*system, 1, 10);
  EXPECT_EQ(system->map().keyframe_count(), 0U);
  system->set_mapping(true);
  feed(*system, 10, 20);
  system->finish();
  EXPECT_EQ(system->trajectory().size(), 10U);
}

TEST(System, BeginsANewMapWhenItCannotFindItselfAndJoinsThemLater) {
  SystemOptions options = deterministic();
  options.new_map_after = 3;
  options.relocalization.acceptance.min_inliers = 100000;  // never satisfied
  options.relocalization.consensus.min_inliers = 100000;
  options.close_loops = false;
  const auto apart = make_system(options);
  feed(*apart, 0, 30);
  apart->begin_sequence();
  feed(*apart, 0, kFrames, 100.0);
  apart->finish();
  ASSERT_EQ(apart->components().size(), 2U);
  EXPECT_EQ(apart->components()[0].component, 1U);  // where most frames were tracked
  EXPECT_EQ(apart->components()[0].frames, static_cast<std::size_t>(kFrames - 3));
  EXPECT_EQ(apart->components()[1].frames, 30U);
  EXPECT_EQ(apart->trajectory(0).size(), 30U);

  options.close_loops = true;
  const auto together = make_system(options);
  feed(*together, 0, 30);
  together->begin_sequence();
  feed(*together, 0, kFrames, 100.0);
  together->finish();
  ASSERT_EQ(together->components().size(), 1U);
  EXPECT_EQ(together->trajectory().size(), static_cast<std::size_t>(30 + kFrames - 3));
  bool joined = false;
  for (const LoopRecord& record : together->loop_log().records()) {
    joined = joined || (record.accepted && record.effect == "join");
  }
  EXPECT_TRUE(joined);
  // Both recordings in one world: that of the first camera of the first.
  Trajectory first;
  Trajectory second;
  for (const StampedPose& pose : together->trajectory()) {
    (pose.stamp < 50.0 ? first : second).push_back(pose);
  }
  EXPECT_LT(worst_error(first), 0.02);
  EXPECT_LT(worst_error(second, 100.0), 0.02);
}

TEST(System, FindsItselfByWeakPosesOfThreeFramesInARow) {
  SystemOptions options = deterministic();
  options.mode = "localization";
  options.relocalization.acceptance.min_inliers = 100000;  // no frame is enough by itself
  const auto system = make_system(options);
  system->load_map(known_map(), {});
  feed(*system, 20, 22, 100.0);
  system->begin_sequence();  // these two say nothing about what follows
  feed(*system, 25, kFrames, 101.0);
  system->finish();
  for (std::size_t i = 0; i < system->frames().size(); ++i) {
    const bool found = system->frames()[i].state == TrackingState::kTracking;
    EXPECT_EQ(found, i >= 4) << i;
  }
  EXPECT_LT(worst_error(system->trajectory(), 101.0), 0.02);
}

TEST(System, DoesNotGiveUpAMapForACoveredLens) {
  SystemOptions options = deterministic();
  options.new_map_after = 3;
  const auto system = make_system(options);
  feed(*system, 0, 30);
  for (int i = 30; i < 40; ++i) {
    RgbdImage covered = recording().images()[static_cast<std::size_t>(i)];
    covered.depth = cv::Mat::zeros(covered.depth.size(), covered.depth.type());
    covered.color = covered.color.clone();
    std::memset(covered.color.data, 0xFF, sizeof(std::int32_t));
    system->process(covered);
  }
  feed(*system, 40, kFrames);
  system->finish();
  EXPECT_EQ(system->components().size(), 1U);
  EXPECT_EQ(system->trajectory().size(), static_cast<std::size_t>(kFrames - 10));
}

TEST(System, GivesItsMapWhileItGrows) {
  const auto system = make_system(deterministic());
  std::size_t before = 0;
  for (int i = 0; i < kFrames; i += 10) {
    feed(*system, i, i + 10);
    std::size_t keyframes = 0;
    EXPECT_TRUE(system->read_map([&](const Map& map, const std::vector<LoopEdge>& loops) {
      keyframes = map.keyframe_count();
      EXPECT_EQ(&loops, &system->closed_loops());
    }));
    EXPECT_GE(keyframes + 1, before);
    before = keyframes;
  }
  EXPECT_GT(before, 4U);
  EXPECT_THROW(system->read_map([](const Map&, const std::vector<LoopEdge>&) { throw 5; }), int);
  system->finish();  // nothing is held up
  EXPECT_TRUE(system->map_is_whole());
}

TEST(System, GivesUpTheLastAdjustmentWhereItMustStop) {
  const auto adjusted = make_system(deterministic());
  const auto stopped = make_system(deterministic());
  Map before;
  feed(*adjusted, 0, kFrames);
  feed(*stopped, 0, kFrames);
  stopped->read_map(
      [&](const Map& map, const std::vector<LoopEdge>&) { before = Map(take_apart(map)); });
  adjusted->finish();
  stopped->finish([] { return false; });
  ASSERT_EQ(stopped->keyframe_trajectory().size(), adjusted->keyframe_trajectory().size());
  EXPECT_EQ(stopped->trajectory().size(), static_cast<std::size_t>(kFrames));
  // The copy has ids of its own, in the same order.
  const auto farthest = [&](const Map& map) {
    double distance = 0.0;
    const std::vector<KeyframeId> ids = map.keyframe_ids();
    const std::vector<KeyframeId> old_ids = before.keyframe_ids();
    for (std::size_t i = 0; i < ids.size() && i < old_ids.size(); ++i) {
      distance =
          std::max(distance, translation_distance(map.keyframe(ids[i]).world_from_camera,
                                                  before.keyframe(old_ids[i]).world_from_camera));
    }
    return distance;
  };
  EXPECT_GT(farthest(adjusted->map()), 0.0);
  EXPECT_EQ(farthest(stopped->map()), 0.0);
}

}  // namespace
}  // namespace dxslam
