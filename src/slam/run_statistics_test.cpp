// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "slam/run_statistics.h"

#include <gtest/gtest.h>

#include "slam/system.h"
#include "slam/test_recording.h"

namespace dxslam {
namespace {

FrameTracked frame_of(double extract_ms, double track_ms) {
  FrameTracked tracked;
  tracked.extract_ms = extract_ms;
  tracked.track_ms = track_ms;
  return tracked;
}

TEST(RunStatistics, AddUpWhatTheMessagesTell) {
  RunStatistics statistics;
  statistics.add(frame_of(10.0, 2.0));
  FrameTracked sought = frame_of(20.0, 4.0);
  sought.relocalize_ms = 3.0;
  sought.request_dropped = true;
  statistics.add(sought);
  KeyframeMapped mapped;
  mapped.insert_ms = 1.0;
  mapped.report.new_points = 5;
  mapped.report.culled_keyframes = {1, 2};
  statistics.add(mapped);
  statistics.add(mapped);
  statistics.add(RecordingEnded{1, 7, 8});
  statistics.add(RunFinished{9.0});
  const auto stages = statistics.stages();
  EXPECT_EQ(stages.at("frame").count, 2U);
  EXPECT_EQ(stages.at("frame").max_ms, 24.0);
  EXPECT_EQ(stages.at("extract").total_ms, 30.0);
  EXPECT_EQ(stages.at("relocalize").count, 1U);
  EXPECT_EQ(stages.at("map_insert").total_ms, 2.0);
  EXPECT_EQ(stages.at("full_bundle").max_ms, 9.0);
  EXPECT_EQ(statistics.mapping().keyframes, 2);
  EXPECT_EQ(statistics.mapping().new_points, 10);
  EXPECT_EQ(statistics.mapping().culled_keyframes, 4);
  EXPECT_EQ(statistics.mapping().dropped_requests, 1);
  EXPECT_EQ(statistics.map_sizes().at(1).points, 8U);
}

TEST(RunStatistics, AreThoseOfTheRun) {
  for (const bool deterministic : {true, false}) {
    SystemOptions options;
    options.features = "recording";
    options.deterministic = deterministic;
    options.loop_detection.max_distance_global = 0.2;
    System system(recording().camera(), std::make_unique<RecordingExtractor>(), options);
    const SubscriptionPtr reader =
        system.subscribe(Subscription::kUnbounded, RunStatistics::kinds());
    for (int round = 0; round < 2; ++round) {
      EXPECT_EQ(system.begin_sequence(), round);
      for (RgbdImage image : recording().images()) {
        image.stamp += 100.0 * round;
        system.process(image);
      }
    }
    system.finish();
    RunStatistics statistics;
    while (const MessagePtr message = reader->try_next()) statistics.add(message->event);
    const auto stages = statistics.stages();
    EXPECT_EQ(stages.at("frame").count, 2U * kFrames);
    EXPECT_EQ(stages.at("map_insert").count, stages.at("loop_closing").count);
    EXPECT_EQ(stages.at("full_bundle").count, 1U);
    ASSERT_EQ(statistics.map_sizes().size(), 2U);
    EXPECT_GT(statistics.map_sizes().at(0).keyframes, 2U);
    EXPECT_EQ(statistics.map_sizes().at(1).keyframes, system.map().keyframe_count());
    EXPECT_LT(statistics.map_sizes().at(1).keyframes, 2 * statistics.map_sizes().at(0).keyframes);
    EXPECT_EQ(statistics.mapping().keyframes - statistics.mapping().culled_keyframes,
              static_cast<std::int64_t>(system.map().keyframe_count()));
  }
}

}  // namespace
}  // namespace dxslam
