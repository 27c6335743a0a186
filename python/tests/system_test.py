# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The dxslam authors
"""Images in, poses, events and a map out."""
import gc
import os
import subprocess
import tempfile
import threading
import time
import unittest
import weakref
from pathlib import Path

import numpy as np

import dxslam
import recording


class Results(unittest.TestCase):
    def test_trajectory_is_right(self):
        slam, _, _ = recording.finished()
        poses = slam.trajectory()
        self.assertGreaterEqual(len(poses), 0.9 * len(recording.images()))
        error = dxslam.evaluate.ate(recording.source().ground_truth, poses).position
        self.assertLess(error.rmse, 0.02)
        keyframes = slam.keyframe_trajectory()
        self.assertGreater(len(keyframes), 1)
        self.assertLessEqual(set(keyframes.stamps), set(poses.stamps))
        self.assertEqual(slam.components()[0].frames, len(poses))
        self.assertEqual(len(slam.trajectory(component=7)), 0)

    def test_frames_are_what_the_callback_was_told(self):
        slam, told, _ = recording.finished()
        frames = slam.frames()
        self.assertEqual([f.stamp for f in frames], [stamp for stamp, _, _ in recording.images()])
        self.assertEqual([f.stamp for f in told], [f.stamp for f in frames])
        self.assertEqual([f.inliers for f in told], [f.inliers for f in frames])
        self.assertEqual(frames[-1].index, len(frames) - 1)
        self.assertEqual(frames[-1].world_from_camera.shape, (4, 4))
        self.assertEqual(frames[-1].state, dxslam.TrackingState.TRACKING)
        with self.assertRaises(IndexError):
            frames[len(frames)]
        self.assertEqual(slam.callback_failures(), (0, ""))
        self.assertGreater(slam.times()["extract"].median_ms, 0)

    def test_images_of_a_source_and_arrays_are_the_same(self):
        results = []
        for as_arrays in (False, True):
            with recording.system(options=dxslam.Options(deterministic=True)) as slam:
                for i, (stamp, color, depth) in enumerate(recording.images()[:12]):
                    if as_arrays:
                        slam.process(stamp, color, depth=depth)
                    else:
                        slam.process(recording.source().read(i))
            results.append(slam.trajectory().to_tum())
        self.assertTrue(np.array_equal(*results))

    def test_equals_the_command_to_the_bit(self):
        program = os.environ.get("DXSLAM_PROGRAM")
        if not program:
            self.skipTest("DXSLAM_PROGRAM is not set")
        options = dxslam.Options(deterministic=True, features="orb")
        with dxslam.System(recording.source().camera, options) as slam:
            for image in recording.source():
                slam.process(image)
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([program, "run", recording.PATH, "--deterministic", "--features", "orb",
                            "--out", folder], check=True, capture_output=True)
            ours = Path(folder) / "ours.txt"
            slam.trajectory().write(ours)
            self.assertEqual(ours.read_text(), (Path(folder) / "trajectory.txt").read_text())


class Use(unittest.TestCase):
    def test_results_are_for_afterwards(self):
        slam = recording.system()
        slam.process(*recording.images()[0])
        for early in (slam.trajectory, slam.frames, slam.map, slam.components):
            with self.assertRaisesRegex(dxslam.ContractError, "after finish"):
                early()
        slam.finish()
        slam.finish()  # does nothing more
        self.assertEqual(len(slam.frames()), 1)
        with self.assertRaisesRegex(dxslam.ContractError, "after finish"):
            slam.process(*recording.images()[1])

    def test_one_thread_at_a_time(self):
        # The callback is called while process() of a deterministic system is under way.
        raised = []

        def again(_):
            try:
                slam.process(*recording.images()[1])
            except dxslam.ContractError as error:
                raised.append(str(error))

        slam = recording.system(options=dxslam.Options(deterministic=True), on_frame=again)
        slam.process(*recording.images()[0])
        self.assertEqual(len(raised), 1)
        self.assertIn("one thread at a time", raised[0])

    def test_an_exception_ends_the_run_without_adjusting(self):
        with self.assertRaisesRegex(KeyError, "mine"):
            with recording.system() as slam:
                slam.process(*recording.images()[0])
                raise KeyError("mine")
        self.assertEqual(len(slam.frames()), 1)

    def test_what_a_callback_raises_ends_nothing(self):
        def fails(frame):
            raise ValueError(f"frame {frame.index}")

        with recording.system(on_frame=fails) as slam:
            for image in recording.images()[:3]:
                slam.process(*image)
        count, first = slam.callback_failures()
        self.assertEqual(count, 3)
        self.assertIn("ValueError: frame 0", first)
        self.assertEqual(len(slam.frames()), 3)

    def test_the_gil_is_released(self):
        ticks, running = [0], True

        def tick():
            while running:
                ticks[0] += 1
                time.sleep(0)

        thread = threading.Thread(target=tick)
        slam = recording.system(extractor=recording.network(),
                                options=dxslam.Options(deterministic=True))
        slam.process(*recording.images()[0])
        thread.start()
        most = 0
        for image in recording.images()[1:4]:
            before = ticks[0]
            slam.process(*image)
            most = max(most, ticks[0] - before)
        running = False
        thread.join()
        self.assertGreater(most, 10)

    def test_goes_without_being_finished(self):
        held = threading.Event()
        slam = recording.system(on_frame=lambda _: held.wait(0.2))
        for image in recording.images()[:3]:
            slam.process(*image)
        del slam
        gc.collect()

    def test_goes_with_its_callback(self):
        class Robot:
            def __init__(self):
                self.slam = recording.system(on_frame=self.told)

            def told(self, frame):
                self.frame = frame

        robot = Robot()
        robot.slam.process(*recording.images()[0])
        gone = weakref.ref(robot)
        del robot
        gc.collect()
        self.assertIsNone(gone())

    def test_live_images_may_be_dropped(self):
        blocked, seen = threading.Event(), []

        def slow(frame):
            seen.append(frame)
            blocked.wait(10)

        slam = recording.system(on_frame=slow)
        taken = [slam.try_process(*image) for image in recording.images()[:8]]
        self.assertTrue(taken[0])
        self.assertIn(False, taken)
        blocked.set()
        slam.finish()
        self.assertEqual(len(slam.frames()), sum(taken))
        self.assertEqual(len(seen), sum(taken))


class Events(unittest.TestCase):
    def test_stream_adds_up_to_the_map(self):
        slam, _, events = recording.finished()
        keyframes, points = {}, {}
        for event in events:
            if not isinstance(event, dxslam.MapChanged):
                continue
            for rows in (event.added_keyframes, event.moved_keyframes):
                keyframes.update(zip(rows.ids.tolist(), rows.world_from_camera))
            for rows in (event.added_points, event.moved_points):
                points.update(zip(rows.ids.tolist(), rows.positions))
            for gone in event.removed_keyframes.tolist():
                del keyframes[gone]
            for gone in event.removed_points.tolist():
                del points[gone]
        final = slam.map()
        self.assertEqual(sorted(keyframes), final.keyframes().ids.tolist())
        self.assertEqual(sorted(points), final.points().ids.tolist())
        self.assertTrue(np.array_equal([keyframes[i] for i in sorted(keyframes)],
                                       final.keyframes().world_from_camera))
        self.assertTrue(np.array_equal([points[i] for i in sorted(points)],
                                       final.points().positions))

    def test_messages(self):
        _, told, events = recording.finished()
        self.assertEqual([e.number for e in events], list(range(1, len(events) + 1)))
        versions = [e.map_version for e in events]
        self.assertEqual(versions, sorted(versions))
        tracked = [e for e in events if isinstance(e, dxslam.FrameTracked)]
        self.assertEqual([e.frame.stamp for e in tracked], [f.stamp for f in told])
        self.assertGreater(tracked[0].extract_ms, 0)
        match tracked[1]:
            case dxslam.FrameTracked(frame, extract_ms=ms):
                self.assertEqual((frame.index, ms), (1, tracked[1].extract_ms))
        self.assertRegex(repr(tracked[0]), r"^FrameTracked\(number=\d+, frame=TrackedFrame\(index=0,")
        with self.assertRaises(AttributeError):
            tracked[0].extract_ms = 1.0
        self.assertIsNone(tracked[0].covariance)  # the origin by definition
        self.assertEqual(tracked[1].covariance.shape, (6, 6))
        self.assertTrue((np.linalg.eigvalsh(tracked[1].covariance) > 0).all())
        mapped = [e.report.keyframe for e in events if isinstance(e, dxslam.KeyframeMapped)]
        self.assertEqual(mapped, sorted(set(mapped)))
        self.assertIsInstance(events[0], dxslam.RecordingBegun)
        self.assertIsInstance(events[-1], dxslam.RunFinished)

    def test_every_event_has_a_class(self):
        classes = [value for value in vars(dxslam).values()
                   if isinstance(value, type) and issubclass(value, dxslam.Event)]
        self.assertGreaterEqual(len(classes), 9)
        for event in set(classes) - {dxslam.Event}:
            self.assertTrue(event.__match_args__, event)

    def test_a_reader_that_does_not_read_loses_the_oldest(self):
        with recording.system() as slam:
            slow = slam.subscribe(capacity=2)
            self.assertIsNone(slow.next(timeout=0))
            for image in recording.images()[:5]:
                slam.process(*image)
        self.assertTrue(slow.has_ended is False or slow.lost > 0)
        left = list(slow)
        self.assertEqual(len(left), 2)
        self.assertEqual(left[-1].number, slow.lost + 2)
        self.assertTrue(slow.has_ended)
        self.assertIsNone(slow.next())

    def test_recordings_are_told_apart(self):
        with recording.system() as slam:
            events = slam.subscribe()
            for _ in range(2):
                slam.begin_sequence()
                slam.process(*recording.images()[0])
        begun = [e.recording for e in events if isinstance(e, dxslam.RecordingBegun)]
        self.assertEqual(begun, [0, 1])

    def test_kinds(self):
        with recording.system() as slam:
            events = slam.subscribe(kinds=[dxslam.FrameTracked])
            for image in recording.images()[:3]:
                slam.process(*image)
            for wrong in ([dxslam.Event], [dxslam.System], ["FrameTracked"], [3]):
                with self.assertRaisesRegex(TypeError, "classes of events"):
                    slam.subscribe(kinds=wrong)
        self.assertEqual([event.frame.index for event in events], [0, 1, 2])

    def test_all_poses(self):
        slam, _, _ = recording.finished()
        everything = slam.all_poses()
        self.assertEqual(everything.stamps.tolist(), slam.trajectory().stamps.tolist())
        self.assertTrue(np.allclose(everything.world_from_camera,
                                    slam.trajectory().world_from_camera))
        self.assertEqual(everything.map_version, slam.whole_map().map_version)

    def test_whole_map(self):
        with recording.system() as slam:
            for image in recording.images()[:5]:
                slam.process(*image)
            whole = slam.whole_map()
        self.assertIsInstance(whole, dxslam.MapChanged)
        self.assertGreater(len(whole.added_points), 50)
        self.assertGreater(whole.map_version, 0)


if __name__ == "__main__":
    unittest.main()
