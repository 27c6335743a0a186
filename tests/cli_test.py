#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The dxslam authors
"""Runs the program as a user does: commands, files, exit codes.

usage: cli_test.py [CLASS[.test]]   with $DXSLAM_PROGRAM or build/release/dxslam
"""
import json
import math
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PROGRAM = os.environ.get("DXSLAM_PROGRAM", str(ROOT / "build" / "release" / "dxslam"))
FRAMES = 60
SLOWER = 10 if os.environ.get("DXSLAM_SANITIZE") else 1
TIMEOUT = 300 * SLOWER  # seconds; against programs that hang

BAD_USAGE, BAD_INPUT, TRACKING_FAILED, INTERRUPTED = 2, 3, 4, 5


def dxslam(*arguments):
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True,
                          stdin=subprocess.DEVNULL, timeout=TIMEOUT)


def poses(file):
    """Rows of a TUM trajectory as lists of eight numbers."""
    lines = [line for line in Path(file).read_text().splitlines() if not line.startswith("#")]
    return [[float(word) for word in line.split()] for line in lines]


def run_tests():
    """Those of the program that was started. Exits with 77 if all are skipped, as ctest is told."""
    # What is ignored here, as below nohup, would be in the programs, too.
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, signal.SIG_DFL)
    outcome = unittest.main(verbosity=2, exit=False).result
    if outcome.testsRun and len(outcome.skipped) == outcome.testsRun:
        sys.exit(77)
    sys.exit(not outcome.wasSuccessful())


class Recorded(unittest.TestCase):
    """Tests that share one small synthetic recording, which they must not change."""

    frames, seed = FRAMES, 7

    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory(prefix="dxslam_cli_")
        cls.addClassCleanup(folder.cleanup)
        cls.folder = Path(folder.name)
        cls.recording = cls.folder / "recording"
        cls.prepare("synth", cls.recording, "--frames", cls.frames, "--seed", cls.seed)

    @staticmethod
    def prepare(*command):
        done = dxslam(*command)
        if done.returncode:
            raise RuntimeError(f"dxslam {command[0]}: exit {done.returncode}: {done.stderr}")

    def run_orb(self, out, *options, recording=None):
        return dxslam("run", recording or self.recording, "--features", "orb", "--out", out,
                      *options)

    def succeed(self, done):
        self.assertEqual(done.returncode, 0, done.stderr)
        return done

    def copy(self):
        """A copy of the recording for the test to break."""
        copy = self.folder / self.id().split(".")[-1]
        shutil.copytree(self.recording, copy)
        return copy

    def refuse(self, done, *mentioned):
        """The program said no in one sentence that holds all of `mentioned`."""
        self.assertEqual(done.returncode, BAD_INPUT, done.stderr)
        lines = done.stderr.strip().splitlines()
        self.assertEqual(len(lines), 1, done.stderr)
        self.assertTrue(lines[0].startswith("dxslam: "), lines[0])
        for text in mentioned:
            self.assertIn(str(text), lines[0])


class Usage(unittest.TestCase):
    def test_version(self):
        done = dxslam("--version")
        self.assertEqual(done.returncode, 0)
        self.assertRegex(done.stdout, r"^dxslam \d+\.\d+\.\d+")

    def test_help_names_the_commands(self):
        done = dxslam("--help")
        self.assertEqual(done.returncode, 0)
        for command in ("run", "eval", "synth", "config"):
            self.assertRegex(done.stdout, rf"(?m)^\s+{command}\b")

    def test_every_command_has_help(self):
        for command in (["run"], ["eval", "ate"], ["eval", "rpe"], ["synth"], ["config", "dump"]):
            done = dxslam(*command, "--help")
            self.assertEqual(done.returncode, 0, command)
            self.assertIn("--help", done.stdout)

    def test_unknown_words_are_bad_usage(self):
        for words in ([], ["fly"], ["run"], ["run", "x", "--fly"], ["eval", "ate", "one"],
                      ["run", "x", "--stride", "two"]):
            done = dxslam(*words)
            self.assertEqual(done.returncode, BAD_USAGE, words)
            self.assertTrue(done.stderr, words)


class Config(Recorded):
    def dumped(self):
        text = self.succeed(dxslam("config", "dump")).stdout
        file = self.folder / "dumped.yaml"
        file.write_text(text)
        return text, file

    def run_with(self, file):
        return self.run_orb(self.folder / "out", "--max-frames", 3, "--config", file)

    def test_dump_is_read_back(self):
        text, file = self.dumped()
        self.assertIn("tracking:", text)
        self.succeed(self.run_with(file))

    def test_users_see_few_options_and_experts_all(self):
        def options(text):
            return {line.split(":")[0].strip() for line in text.splitlines()
                    if re.match(r"\s*\w+: \S", line) and not line.startswith("#")}

        users, _ = self.dumped()
        experts = self.succeed(dxslam("config", "dump", "--all")).stdout
        self.assertTrue(15 <= len(re.findall(r"(?m)^ *\w+: \S", users)) <= 25, users)
        self.assertLess(options(users), options(experts))
        self.assertIn("deterministic", options(users))
        self.assertIn("--all", users)
        file = self.folder / "all.yaml"
        file.write_text(experts)
        self.succeed(self.run_with(file))

    def test_options_that_contradict_each_other_are_refused(self):
        file = self.folder / "contradiction.yaml"
        file.write_text("tracking: {weak_agreement: 0.9}\n")
        self.refuse(self.run_with(file), "tracking.weak_agreement is 0.9", "fair_agreement")

    def test_options_of_the_loop_experiment_are_no_options_of_a_run(self):
        file = self.folder / "loops.yaml"
        file.write_text("loop_detection: {min_inliers_hf: 30}\n")
        self.refuse(self.run_with(file), "min_inliers_hf", "loops.yaml")

    def test_unknown_key_is_refused(self):
        _, file = self.dumped()
        wrong = self.folder / "unknown.yaml"
        wrong.write_text(file.read_text() + "speed_of_light: 3\n")
        self.refuse(self.run_with(wrong), "speed_of_light", "unknown.yaml")

    def test_value_out_of_range_is_refused(self):
        text, _ = self.dumped()
        wrong = self.folder / "range.yaml"
        wrong.write_text(re.sub(r"(?m)^(queued_frames):.*$", r"\1: 0", text))
        self.refuse(self.run_with(wrong), "queued_frames", "range.yaml")

    def test_methods_of_the_loop_experiment_are_refused(self):
        wrong = self.folder / "method.yaml"
        wrong.write_text("loop_detection:\n  method: hf-bow-global+geometry\n")
        self.refuse(self.run_with(wrong), "loop_detection.method", "+geometry")

    def test_missing_file_is_refused(self):
        self.refuse(self.run_with(self.folder / "nowhere.yaml"), "nowhere.yaml")


class BrokenInput(Recorded):
    def refuse_run(self, recording, *mentioned):
        self.refuse(self.run_orb(self.folder / "out", recording=recording), *mentioned)

    def edit(self, file, change):
        lines = file.read_text().splitlines()
        change(lines)
        file.write_text("\n".join(lines) + "\n")

    def first_row(self, lines):
        return next(i for i, line in enumerate(lines) if not line.startswith("#"))

    def test_missing_folder(self):
        self.refuse_run(self.folder / "nowhere", "nowhere")

    def test_folder_of_no_known_format(self):
        empty = self.folder / "empty"
        empty.mkdir()
        self.refuse_run(empty, "empty")

    def test_empty_list(self):
        copy = self.copy()
        (copy / "rgb.txt").write_text("# nothing\n")
        self.refuse_run(copy, "rgb.txt")

    def test_stamp_that_is_no_number(self):
        copy = self.copy()

        def change(lines):
            row = self.first_row(lines) + 4
            for wrong in lines[row:row + self.wrong]:
                lines[lines.index(wrong)] = "nan " + wrong.split()[1]
            self.line = row + 1
        self.wrong = 1
        self.edit(copy / "rgb.txt", change)
        done = self.succeed(self.run_orb(self.folder / "out", recording=copy))
        self.assertIn(f"rgb.txt:{self.line}: stamp is 'nan'", done.stderr)
        self.wrong = 10
        self.edit(copy / "rgb.txt", change)
        self.refuse_run(copy, f"rgb.txt:{self.line}", "nan", "10 cannot be used")

    def test_stamps_that_go_backwards(self):
        copy = self.copy()

        def change(lines):
            row = self.first_row(lines)
            lines[row:] = lines[row + 20:] + lines[row:row + 20]
            self.line = len(lines) - 20 + 1
        self.edit(copy / "rgb.txt", change)
        self.refuse_run(copy, f"rgb.txt:{self.line}", "expected rising stamps")

    def test_unknown_features(self):
        out = self.folder / "out"
        done = dxslam("run", self.recording, "--features", "psychic", "--out", out)
        self.assertEqual(done.returncode, BAD_USAGE, done.stderr)
        self.assertIn("psychic", done.stderr)
        self.refuse(dxslam("run", self.recording, "--features", "psychic.yaml", "--out", out),
                    "psychic")

    def test_one_broken_frame_is_skipped_and_reported(self):
        copy = self.copy()
        depth = sorted((copy / "depth").iterdir())[20]
        depth.write_bytes(depth.read_bytes()[:200])
        out = self.folder / "skipped"
        done = self.succeed(self.run_orb(out, recording=copy))
        self.assertIn(depth.name, done.stdout + done.stderr)
        summary = json.loads((out / "summary.json").read_text())
        self.assertEqual(len(summary["skipped_frames"]), 1)
        self.assertIn(depth.name, json.dumps(summary["skipped_frames"]))
        self.assertEqual(len(poses(out / "trajectory.txt")), FRAMES - 1)

    def test_output_folder_that_cannot_be_made(self):
        file = self.folder / "file"
        file.write_text("")
        self.refuse(self.run_orb(file / "out"), "file")

    def test_evaluation_of_broken_trajectories(self):
        good = self.recording / "groundtruth.txt"
        bad = self.folder / "bad.txt"
        bad.write_text("1.0 0 0 0 0 0 0 1\n2.0 0 0\n")
        self.refuse(dxslam("eval", "ate", good, bad), "bad.txt:2")
        bad.write_text("1e6 0 0 0 0 0 0 1\n")
        self.refuse(dxslam("eval", "ate", good, bad))
        self.refuse(dxslam("eval", "ate", good, self.folder / "none.txt"), "none.txt")


class Said(Recorded):
    """What a run cannot do, or cannot have done, is said."""

    frames = 20

    def summary(self, out):
        return json.loads((out / "summary.json").read_text())

    def test_features_without_a_global_descriptor_find_no_place(self):
        map_, out = self.folder / "m.dxmap", self.folder / "found"
        done = self.succeed(dxslam("run", self.recording, "--features", "orb", "--map-out", map_))
        self.assertIn("no global descriptor: a place that was seen before", done.stderr)
        done = self.run_orb(out, "--map-in", map_, "--mode", "localization")
        self.assertEqual(done.returncode, TRACKING_FAILED, done.stderr)
        self.assertIn("no global descriptor: no frame can be found in the stored map", done.stderr)
        self.assertIn("no keyframe of the map has a global descriptor",
                      self.summary(out)["no_pose_reason"])

    def test_a_missing_vocabulary(self):
        out = self.folder / "wordless"
        done = self.succeed(dxslam("run", self.recording, "--features", "opencv_orb", "--out", out))
        self.assertIn("no vocabulary of features `opencv_orb`", done.stderr)
        self.assertTrue(any("no loops are closed" in note for note in self.summary(out)["notes"]))
        done = self.succeed(dxslam("run", self.recording, "--features", "opencv_orb",
                                   "--vocabulary", "none"))
        self.assertNotIn("no vocabulary", done.stderr)

    def test_depth_beyond_the_camera(self):
        copy, out = self.copy(), self.folder / "far"
        file = copy / "calibration.yaml"
        file.write_text(re.sub(r"(?m)^max_depth:.*\n", "", file.read_text()) + "max_depth: 0.05\n")
        done = self.run_orb(out, recording=copy)
        self.assertEqual(done.returncode, TRACKING_FAILED, done.stderr)
        self.assertIn("beyond max_depth", self.summary(out)["no_pose_reason"])

    def test_real_time_of_stamps_that_are_no_seconds(self):
        copy = self.copy()
        for name in ("rgb.txt", "depth.txt"):
            lines = [line.split() for line in (copy / name).read_text().splitlines() if line[0] != "#"]
            (copy / name).write_text("".join(f"{float(stamp) * 1e9:.0f} {image}\n"
                                             for stamp, image in lines))
        done = dxslam("run", copy, "--realtime")
        self.assertEqual(done.returncode, BAD_INPUT, done.stderr)
        self.assertIn("--realtime, frame 1", done.stderr)

    def test_a_truth_that_cannot_be_compared(self):
        copy = self.copy()
        rows = poses(copy / "groundtruth.txt")
        self.edit(copy, [[row[0], 0.001 * i, 0, 0, *row[4:]] for i, row in enumerate(rows)])
        done = self.succeed(self.run_orb(self.folder / "line", recording=copy))
        self.assertIn("not compared with the true trajectory", done.stderr)

    def test_a_short_path_tells_no_scale(self):
        copy = self.copy()
        rows = poses(copy / "groundtruth.txt")
        first = rows[0]
        for factor, advised in ((1.5, True), (0.02, False)):
            self.edit(copy, [[row[0], *[f + 2 * factor * (v - f) for v, f in zip(row[1:4], first[1:4])],
                              *row[4:]] for row in rows])
            done = self.succeed(self.run_orb(self.folder / "scale", recording=copy))
            self.assertEqual("depth_factor of" in done.stderr, advised, done.stderr)
            self.assertEqual("calibration (fx" in done.stderr, advised, done.stderr)

    def edit(self, recording, rows):
        text = "\n".join(" ".join(str(value) for value in row) for row in rows)
        (recording / "groundtruth.txt").write_text(text + "\n")


class EndToEnd(Recorded):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.out = cls.folder / "result"
        cls.done = dxslam("run", cls.recording, "--features", "orb", "--out", cls.out)

    def test_ends_well(self):
        self.succeed(self.done)

    def test_tracks_every_frame(self):
        rows = poses(self.out / "trajectory.txt")
        self.assertEqual(len(rows), FRAMES)
        for row in rows:
            self.assertEqual(len(row), 8)
            self.assertAlmostEqual(math.hypot(*row[4:]), 1.0, places=5)
        stamps = [row[0] for row in rows]
        self.assertEqual(stamps, sorted(set(stamps)))

    def test_keyframes_are_frames(self):
        stamps = {row[0] for row in poses(self.out / "trajectory.txt")}
        keyframes = [row[0] for row in poses(self.out / "keyframes.txt")]
        self.assertGreater(len(keyframes), 1)
        self.assertLessEqual(set(keyframes), stamps)

    def test_summary(self):
        summary = json.loads((self.out / "summary.json").read_text())
        self.assertEqual(summary["frames"], FRAMES)
        self.assertEqual(summary["tracked"], FRAMES)
        self.assertEqual(summary["lost_intervals"], [])
        self.assertEqual(summary["keyframes"], len(poses(self.out / "keyframes.txt")))
        self.assertGreater(summary["points"], 100)
        self.assertGreater(summary["peak_memory_mib"], 1)
        self.assertGreater(summary["startup_ms"], 0)
        frame = summary["stages"]["frame"]
        self.assertEqual(frame["count"], FRAMES)
        self.assertTrue(0 < frame["median_ms"] <= frame["p95_ms"] <= frame["max_ms"])
        self.assertIn("tracking:", summary["configuration"])

    def test_map_is_a_point_cloud(self):
        header, body = (self.out / "map.ply").read_bytes().split(b"end_header\n", 1)
        self.assertTrue(header.startswith(b"ply\n"))
        self.assertGreater(int(re.search(rb"element vertex (\d+)", header).group(1)), 100)
        self.assertTrue(body)

    def test_picture(self):
        self.assertIn("<svg", (self.out / "trajectory.svg").read_text())

    def evaluate(self, measure, *options):
        file = self.folder / f"{measure}.json"
        done = dxslam("eval", measure, self.recording / "groundtruth.txt",
                      self.out / "trajectory.txt", "--json", file, *options)
        self.succeed(done)
        return json.loads(file.read_text())

    def test_is_accurate(self):
        for alignment in ("se3", "sim3"):
            report = self.evaluate("ate", "--align", alignment)
            self.assertEqual(report["position"]["count"], FRAMES)
            self.assertLess(report["position"]["rmse"], 0.03)
        self.assertLess(self.evaluate("rpe")["translation_m"]["rmse"], 0.03)

    def test_low_light_and_stride(self):
        out = self.folder / "dark"
        self.succeed(self.run_orb(out, "--low-light=0.5", "--stride", 2, "--max-frames", 10))
        self.assertEqual(json.loads((out / "summary.json").read_text())["frames"], 10)


class Determinism(Recorded):
    def test_runs_are_equal_to_the_byte(self):
        for name in ("one", "two"):
            self.succeed(self.run_orb(self.folder / name, "--deterministic"))
        for file in ("trajectory.txt", "keyframes.txt", "map.ply"):
            self.assertEqual((self.folder / "one" / file).read_bytes(),
                             (self.folder / "two" / file).read_bytes(), file)

    def test_threads_change_little(self):
        self.succeed(self.run_orb(self.folder / "serial", "--deterministic"))
        self.succeed(self.run_orb(self.folder / "threaded"))
        serial = poses(self.folder / "serial" / "trajectory.txt")
        threaded = poses(self.folder / "threaded" / "trajectory.txt")
        self.assertEqual([row[0] for row in serial], [row[0] for row in threaded])
        self.assertLess(max(math.dist(a[1:4], b[1:4]) for a, b in zip(serial, threaded)), 0.03)

    def test_recordings_are_equal_to_the_byte(self):
        again = self.folder / "again"
        self.succeed(dxslam("synth", again, "--frames", FRAMES, "--seed", 7))
        for file in sorted(self.recording.rglob("*.*")):
            self.assertEqual(file.read_bytes(),
                             (again / file.relative_to(self.recording)).read_bytes(), file)


class Interruption(Recorded):
    def start(self, out):
        """A run at the camera's own pace that has begun to track when this returns."""
        process = subprocess.Popen(
            [PROGRAM, "run", self.recording, "--features", "orb", "--out", out, "--realtime"],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, stdin=subprocess.DEVNULL)
        self.addCleanup(process.kill)
        trajectory = out / "trajectory.txt"
        deadline = time.monotonic() + TIMEOUT
        while not trajectory.exists() or len(trajectory.read_text().splitlines()) < 4:
            self.assertIsNone(process.poll(), "the run ended before it was stopped")
            self.assertLess(time.monotonic(), deadline, "no pose appeared")
            time.sleep(0.02)
        return process

    def test_interrupt_saves_what_was_made(self):
        out = self.folder / "interrupted"
        process = self.start(out)
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(TIMEOUT), INTERRUPTED)
        self.assertGreater(len(poses(out / "trajectory.txt")), 0)
        self.assertLess(len(poses(out / "trajectory.txt")), FRAMES)
        self.assertTrue(json.loads((out / "summary.json").read_text())["interrupted"])

    def test_kill_leaves_whole_lines(self):
        out = self.folder / "killed"
        process = self.start(out)
        process.kill()
        process.wait(TIMEOUT)
        rows = poses(out / "trajectory.txt")
        self.assertGreater(len(rows), 0)
        for row in rows[:-1]:
            self.assertEqual(len(row), 8)


class RealRecordings(unittest.TestCase):
    """Accuracy on real recordings, with room for the spread between machines."""

    def ate(self, name, *options):
        """Of one deterministic run that tracks every frame, metres."""
        shared = Path(os.environ.get("DXSLAM_SHARED", ROOT.parent / "shared"))
        recording = shared / "data" / name
        if not recording.is_dir():
            self.skipTest(f"{recording} is not there")
        with tempfile.TemporaryDirectory(prefix="dxslam_real_") as folder:
            out, report = Path(folder) / "out", Path(folder) / "ate.json"
            done = dxslam("run", recording, "--out", out, "--deterministic", *options)
            self.assertEqual(done.returncode, 0, done.stderr)
            summary = json.loads((out / "summary.json").read_text())
            self.assertEqual(summary["tracked"], summary["frames"])
            done = dxslam("eval", "ate", recording, out / "trajectory.txt", "--json", report)
            self.assertEqual(done.returncode, 0, done.stderr)
            return json.loads(report.read_text())["position"]["rmse"]

    def check(self, name, most, *options):
        self.assertLess(self.ate(name, *options), most)

    def test_redkitchen(self):
        self.check("7scenes_redkitchen", 0.06, "--stride", 5)

    def test_redkitchen_low_light(self):
        self.check("7scenes_redkitchen", 0.07, "--stride", 5, "--low-light")

    def test_redkitchen_orb(self):
        self.check("7scenes_redkitchen", 0.07, "--features", "orb")

    def test_fr1_rpy(self):
        self.check("tum_fr1_rpy", 0.025)

    def test_hololens(self):
        self.check("hololens", 0.12)


if __name__ == "__main__":
    run_tests()
