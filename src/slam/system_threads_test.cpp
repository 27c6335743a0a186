// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors

// The system in threads against the same system in one: threads may add speed, not errors.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <functional>
#include <stdexcept>

#include "core/error.h"
#include "core/test_threads.h"
#include "slam/system.h"
#include "slam/test_recording.h"

namespace dxslam {
namespace {

SystemOptions options(bool deterministic) {
  SystemOptions options;
  options.features = "recording";
  options.deterministic = deterministic;
  return options;
}

struct Outcome {
  Trajectory trajectory;
  std::size_t keyframes = 0;
  std::size_t points = 0;
};

Outcome run(const SystemOptions& options) {
  System system(recording().camera(), std::make_unique<RecordingExtractor>(), options);
  for (const RgbdImage& image : recording().images()) system.process(image);
  system.finish();
  return {system.trajectory(), system.map().keyframe_count(), system.map().point_count()};
}

// Root mean square distance to the true path; the first camera is the origin of both.
double error_of(const Trajectory& trajectory) {
  double sum = 0.0;
  for (const StampedPose& pose : trajectory) {
    const int index = static_cast<int>(std::lround(30.0 * pose.stamp));
    const double d = translation_distance(pose.world_from_camera, PointScene::pose(place(index)));
    sum += d * d;
  }
  return std::sqrt(sum / static_cast<double>(trajectory.size()));
}

TEST(SystemThreads, AreAsAccurateAsOneThread) {
  const Outcome serial = run(options(true));
  ASSERT_EQ(serial.trajectory.size(), kFrames);
  EXPECT_LT(error_of(serial.trajectory), 0.01);
  ASSERT_GT(serial.keyframes, 4U);
  // Which local map a frame is tracked against depends on who was faster, so no two runs are equal.
  for (const int queued : {1, 2, 8}) {
    SystemOptions threaded_options = options(false);
    threaded_options.queued_frames = queued;
    threaded_options.queued_keyframes = queued;
    const Outcome threaded = run(threaded_options);
    ASSERT_EQ(threaded.trajectory.size(), kFrames) << queued;
    EXPECT_LT(error_of(threaded.trajectory), 0.01) << queued;
    const double ratio =
        static_cast<double>(threaded.keyframes) / static_cast<double>(serial.keyframes);
    EXPECT_GT(ratio, 0.5) << queued;
    EXPECT_LT(ratio, 2.0) << queued;
    for (std::size_t i = 0; i < serial.trajectory.size(); ++i) {
      EXPECT_EQ(threaded.trajectory[i].stamp, serial.trajectory[i].stamp);
      EXPECT_LT(translation_distance(threaded.trajectory[i].world_from_camera,
                                     serial.trajectory[i].world_from_camera),
                0.02)
          << i;
    }
  }
}

TEST(SystemThreads, AreRefusedInOneSentenceWhereThereAreNone) {
  const NoMoreThreads none;
  EXPECT_THROW(System(recording().camera(), std::make_unique<RecordingExtractor>(), options(false)),
               InputError);
}

TEST(SystemThreads, OneThreadRepeatsItselfToTheBit) {
  const Outcome a = run(options(true));
  const Outcome b = run(options(true));
  EXPECT_EQ(a.keyframes, b.keyframes);
  EXPECT_EQ(a.points, b.points);
  ASSERT_EQ(a.trajectory.size(), b.trajectory.size());
  for (std::size_t i = 0; i < a.trajectory.size(); ++i) {
    EXPECT_EQ(a.trajectory[i].world_from_camera.matrix(),
              b.trajectory[i].world_from_camera.matrix());
  }
}

TEST(SystemThreads, LiveInputIsDroppedRatherThanWaitedFor) {
  SystemOptions live = options(false);
  live.queued_frames = 1;
  System system(recording().camera(), std::make_unique<RecordingExtractor>(), live);
  const SubscriptionPtr reader =
      system.subscribe(Subscription::kUnbounded, EventKinds::of<FrameTracked, ImageSkipped>());
  int taken = 0;
  for (const RgbdImage& image : recording().images()) taken += system.try_process(image) ? 1 : 0;
  system.finish();
  EXPECT_GE(taken, 1);
  int tracked = 0;
  int dropped = 0;
  while (const MessagePtr message = reader->try_next()) {
    if (std::holds_alternative<FrameTracked>(message->event)) ++tracked;
    const auto* skipped = std::get_if<ImageSkipped>(&message->event);
    if (skipped != nullptr && skipped->reason == SkipReason::kDropped) ++dropped;
  }
  EXPECT_EQ(tracked, taken);
  EXPECT_EQ(dropped, kFrames - taken);
  EXPECT_EQ(system.frames().size(), static_cast<std::size_t>(taken));
}

TEST(SystemThreads, FindThemselvesAgainInANewRecordingOfTheSamePlace) {
  for (const bool deterministic : {true, false}) {
    System system(recording().camera(), std::make_unique<RecordingExtractor>(),
                  options(deterministic));
    for (const RgbdImage& image : recording().images()) system.process(image);
    system.begin_sequence();
    for (int i = 20; i < 40; ++i) {
      RgbdImage again = recording().images()[static_cast<std::size_t>(i)];
      again.stamp += 100.0;
      system.process(again);
    }
    system.finish();
    EXPECT_EQ(system.components().size(), 1U) << deterministic;
    ASSERT_EQ(system.trajectory().size(), kFrames + 20U) << deterministic;
    for (const StampedPose& pose : system.trajectory()) {
      const double stamp = pose.stamp > 50.0 ? pose.stamp - 100.0 : pose.stamp;
      const int index = static_cast<int>(std::lround(30.0 * stamp));
      EXPECT_LT(translation_distance(pose.world_from_camera, PointScene::pose(place(index))), 0.03)
          << index;
    }
  }
}

TEST(SystemThreads, HandOnWhatWentWrongInside) {
  const auto feed = [](int broken) {
    System system(recording().camera(), std::make_unique<RecordingExtractor>(broken),
                  options(false));
    for (const RgbdImage& image : recording().images()) system.process(image);
    system.finish();
  };
  EXPECT_THROW(feed(0), std::runtime_error);
  EXPECT_THROW(feed(kFrames / 2), std::runtime_error);
  EXPECT_THROW(feed(kFrames - 1), std::runtime_error);
  EXPECT_NO_THROW(feed(kFrames));
}

void expect_the_error(const std::function<void()>& call) {
  try {
    call();
    ADD_FAILURE() << "no error";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "broken encoder");
  }
}

TEST(SystemThreads, AnErrorInsideStaysAndResultsSoFarCanBeRead) {
  for (const bool deterministic : {true, false}) {
    System system(recording().camera(), std::make_unique<RecordingExtractor>(-1, 3),
                  options(deterministic));
    const std::vector<RgbdImage>& images = recording().images();
    expect_the_error([&] {
      for (const RgbdImage& image : images) system.process(image);
      system.finish();
    });
    for (int i = 0; i < 3; ++i) {
      expect_the_error([&] { system.process(images.back()); });
      expect_the_error([&] { system.try_process(images.back()); });
    }
    expect_the_error([&] { system.finish(); });
    expect_the_error([&] { system.finish(); });
    expect_the_error([&] { system.process(images.back()); });
    EXPECT_GT(system.frames().size(), 3U) << deterministic;
    EXPECT_EQ(system.frames()[0].state, TrackingState::kTracking);
    EXPECT_FALSE(system.map_is_whole());
  }
}

TEST(SystemThreads, AnImageThatCannotBeExtractedCostsOnlyItself) {
  for (const bool deterministic : {true, false}) {
    System system(recording().camera(), std::make_unique<RecordingExtractor>(20),
                  options(deterministic));
    const SubscriptionPtr reader = system.subscribe(10, EventKinds::of<ImageSkipped>());
    int failed = 0;
    for (const RgbdImage& image : recording().images()) {
      try {
        system.process(image);
      } catch (const std::runtime_error&) {
        ++failed;
      }
    }
    system.finish();
    EXPECT_EQ(failed, 1);
    const MessagePtr told = reader->try_next();
    ASSERT_NE(told, nullptr);
    const auto& skipped = std::get<ImageSkipped>(told->event);
    EXPECT_EQ(skipped.index, 20);
    EXPECT_EQ(skipped.reason, SkipReason::kNotExtracted);
    EXPECT_EQ(skipped.what, "broken image");
    EXPECT_EQ(system.trajectory().size(), static_cast<std::size_t>(kFrames - 1)) << deterministic;
    EXPECT_TRUE(system.map_is_whole());
  }
}

TEST(SystemThreads, ACallbackThatThrowsEndsNothing) {
  for (const bool deterministic : {true, false}) {
    std::atomic<int> frames{0};
    System system(recording().camera(), std::make_unique<RecordingExtractor>(),
                  options(deterministic), [&](const TrackedFrame&) {
                    if (++frames == 5) throw 5;
                    if (frames == 7) throw std::runtime_error("disk full");
                  });
    for (const RgbdImage& image : recording().images()) system.process(image);
    system.finish();
    EXPECT_EQ(frames, kFrames);
    EXPECT_EQ(system.callback_failures().count, 2);
    EXPECT_FALSE(system.callback_failures().first.empty());
    EXPECT_EQ(system.trajectory().size(), static_cast<std::size_t>(kFrames));
  }
}

TEST(SystemThreads, EndWithoutFinish) {
  for (const int fed : {0, 1, 5, 30}) {
    System system(recording().camera(), std::make_unique<RecordingExtractor>(), options(false));
    for (int i = 0; i < fed; ++i) system.process(recording().images()[static_cast<std::size_t>(i)]);
  }
}

}  // namespace
}  // namespace dxslam
