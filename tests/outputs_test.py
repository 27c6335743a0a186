#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The dxslam authors
"""What `dxslam run` and `dxslam lifelong` leave on the disk when something goes wrong: no pose, outputs
that cannot be written, a start that fails, a kill, two runs at once.

usage: outputs_test.py [CLASS[.test]]   with $DXSLAM_PROGRAM or build/release/dxslam
"""
import json
import os
import pathlib
import random
import resource
import shutil
import signal
import struct
import subprocess
import sys
import time
import unittest
import zlib

from cli_test import BAD_INPUT, INTERRUPTED, PROGRAM, TIMEOUT, TRACKING_FAILED, Recorded, dxslam, \
    poses

FRAMES = 30
WIDTH, HEIGHT = 640, 480  # of the recording
ENOUGH_FOR_SMALL_BLOCKS = 500_000  # but not for an image of this size
CANNOT_BE_LOADED = 127  # exit code of the dynamic loader
LEAST_SHARE = 0.1  # of the images with a pose, for exit code 0
RESULTS = {"trajectory.txt", "trajectory_online.txt", "keyframes.txt", "map.ply", "trajectory.svg",
           "summary.json"}


def names(folder):
    return {path.name for path in folder.iterdir()}


def rows_of(file):
    """Of a list: stamp and name."""
    return [line.split() for line in file.read_text().splitlines() if not line.startswith("#")]


def empty_png(bits):
    """A grey image of zeros."""
    def chunk(kind, data):
        return (struct.pack(">I", len(data)) + kind + data +
                struct.pack(">I", zlib.crc32(kind + data)))
    row = b"\0" + b"\0" * (WIDTH * bits // 8)
    return (b"\x89PNG\r\n\x1a\n" +
            chunk(b"IHDR", struct.pack(">IIBBBBB", WIDTH, HEIGHT, bits, 0, 0, 0, 0)) +
            chunk(b"IDAT", zlib.compress(row * HEIGHT)) + chunk(b"IEND", b""))


class Outputs(Recorded):
    """A folder for each test, beside the recording."""

    frames = FRAMES

    def setUp(self):
        self.folder = type(self).folder / self.id().split(".")[-1]
        self.folder.mkdir()
        self.out = self.folder / "out"

    def run_orb(self, *options, recording=None):
        return dxslam("run", recording or self.recording, "--features", "orb", *options)

    def ends(self, done, code, *said):
        self.assertEqual(done.returncode, code, done.stderr)
        for text in said:
            self.assertIn(text, done.stderr)
        return done

    def copy(self, name="recording"):
        copy = self.folder / name
        shutil.copytree(self.recording, copy)
        return copy

    def without_readings(self):
        """The recording with depth images that hold no reading."""
        copy = self.copy("zero")
        for image in (copy / "depth").iterdir():
            image.write_bytes(empty_png(16))
        return copy

    def black(self):
        copy = self.copy("black")
        for image in (copy / "rgb").iterdir():
            image.write_bytes(empty_png(8))
        return copy

    def summary(self):
        return json.loads((self.out / "summary.json").read_text())


class NoPose(Outputs):
    def test_every_file_is_written_and_says_why(self):
        cases = {"no depth reading": self.without_readings(), "too few keypoints": self.black()}
        for reason, recording in cases.items():
            with self.subTest(reason):
                self.ends(self.run_orb("--out", self.out, recording=recording), TRACKING_FAILED,
                          f"no frame was tracked: {reason}")
                self.assertEqual(names(self.out), RESULTS)
                self.assertEqual(poses(self.out / "trajectory.txt"), [])
                self.assertIn(reason, self.summary()["no_pose_reason"])
                self.assertIn("no pose", (self.out / "trajectory.svg").read_text())

    def test_a_recording_without_depth_is_refused(self):
        colour = self.folder / "colour"
        colour.mkdir()
        for image in (self.recording / "rgb").iterdir():
            shutil.copy(image, colour)
        shutil.copy(self.recording / "calibration.yaml", colour)
        self.refuse(self.run_orb("--out", self.out, recording=colour), "no depth images")
        self.refuse(dxslam("lifelong", colour, "--out", self.out), "no depth images")
        self.assertFalse(self.out.exists())

    def test_an_empty_map_is_never_saved(self):
        home = self.folder / "home.dxmap"
        self.ends(self.run_orb("--map-out", home), 0)
        before = home.read_bytes()
        black = self.black()
        self.ends(self.run_orb("--map-out", home, recording=black), TRACKING_FAILED,
                  "the map is empty")
        self.assertEqual(home.read_bytes(), before)
        new = self.folder / "new.dxmap"
        self.ends(self.run_orb("--map-out", new, recording=black), TRACKING_FAILED)
        self.ends(dxslam("lifelong", black, "--features", "orb", "--out", self.out, "--map-out", new),
                  TRACKING_FAILED, "the map is empty", "no frame was tracked")
        self.assertFalse(new.exists())
        self.assertEqual(json.loads((self.out / "lifelong.json").read_text())[0]["localized"], 0)

    def test_localization_that_finds_nothing(self):
        home = self.folder / "home.dxmap"
        self.ends(self.run_orb("--map-out", home), 0)
        self.ends(self.run_orb("--map-in", home, "--mode", "localization", "--out", self.out,
                               recording=self.black()), TRACKING_FAILED, "no frame was tracked")
        self.assertEqual(names(self.out), RESULTS)

    def test_a_stop_right_after_the_start(self):
        # Both take seconds, so that no signal comes after the end.
        for command in (["run", self.recording, "--realtime"],
                        ["lifelong", *20 * [self.recording]]):
            for delay in (0.0, 0.03, 0.1, 0.3):
                with self.subTest(command=command[0], delay=delay):
                    process = subprocess.Popen([PROGRAM, *map(str, command), "--out", self.out],
                                               stdout=subprocess.DEVNULL,
                                               stderr=subprocess.PIPE, stdin=subprocess.DEVNULL)
                    with process:
                        time.sleep(delay + 0.05)
                        process.send_signal(signal.SIGTERM)
                        said = process.stderr.read().decode()
                    # At the very first the signal may meet a process that is not up yet.
                    self.assertIn(process.returncode, (INTERRUPTED, -signal.SIGTERM), said)
                    self.assertNotIn("internal", said)


class LastResults(Outputs):
    def test_a_start_that_fails_touches_nothing(self):
        self.ends(self.run_orb("--out", self.out), 0)
        before = {name: (self.out / name).read_bytes() for name in names(self.out)}
        bad = self.folder / "bad.dxmap"
        bad.write_text("x")
        both = self.folder / "both.yaml"
        both.write_text("mode: both\n")
        for wrong in (["--map-in", bad], ["--map-in", self.folder / "none.dxmap"],
                      ["--vocabulary", bad], ["--features", "nosuch.yaml"], ["--config", both],
                      ["--map-out", self.folder / "missing" / "m.dxmap"],
                      ["--config", self.folder / "none.yaml"]):
            with self.subTest(wrong):
                self.refuse(dxslam("run", self.recording, "--out", self.out, *wrong))
                self.assertEqual({name: (self.out / name).read_bytes() for name in names(self.out)},
                                 before)

    def test_all_results_are_replaced_and_nothing_else(self):
        self.ends(dxslam("lifelong", self.recording, self.recording, "--features", "orb", "--out",
                         self.out), 0)
        self.assertIn("online_2.txt", names(self.out))
        (self.out / "notes.txt").write_text("mine")
        self.ends(dxslam("lifelong", self.recording, "--features", "orb", "--out", self.out), 0)
        self.assertEqual(names(self.out),
                         {"notes.txt", "online_1.txt", "dxslam_scene.txt", "lifelong.json"})
        (self.out / "trajectory_map1.txt").write_text(
            "# timestamp tx ty tz qx qy qz qw\n")
        self.ends(self.run_orb("--out", self.out), 0)
        self.assertEqual(names(self.out), RESULTS | {"notes.txt"})

    def test_results_without_a_pose_keep_the_last_ones(self):
        self.ends(self.run_orb("--out", self.out), 0)
        before = poses(self.out / "trajectory.txt")
        black = self.black()
        for _ in range(2):
            self.ends(self.run_orb("--out", self.out, recording=black), TRACKING_FAILED)
            self.assertEqual(poses(self.out / "trajectory.txt"), [])
            self.assertEqual(poses(self.out / "previous" / "trajectory.txt"), before)
        self.ends(self.run_orb("--out", self.out), 0)
        self.assertEqual(names(self.out), RESULTS)

    def start_slowly(self, *options):
        """A run that has begun to track when this returns."""
        process = subprocess.Popen([PROGRAM, "run", self.recording, "--features", "orb", "--out",
                                    self.out, "--realtime", *options], stdout=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL, stdin=subprocess.DEVNULL)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        deadline = time.monotonic() + TIMEOUT
        trajectory = self.out / "trajectory.txt"
        # By its time: the number of a removed file may be given to the new one.
        old = trajectory.stat().st_mtime_ns if trajectory.exists() else None

        def has_begun():
            try:
                return trajectory.stat().st_mtime_ns != old and len(poses(trajectory)) >= 3
            except FileNotFoundError:  # not there yet, or on its way to `previous`
                return False

        while not has_begun():
            self.assertIsNone(process.poll(), "the run ended before it was stopped")
            self.assertLess(time.monotonic(), deadline, "no pose appeared")
            time.sleep(0.01)
        return process

    def test_a_folder_that_is_moved_meanwhile(self):
        maps = self.folder / "maps"
        for there in (self.out, maps):
            there.mkdir()
        process = self.start_slowly("--map-out", maps / "m.dxmap")
        for there in (self.out, maps):
            there.rename(self.folder / f"old_{there.name}")
        self.assertEqual(process.wait(TIMEOUT), 0)
        self.assertEqual(names(self.out), RESULTS - {"trajectory_online.txt"})
        self.assertGreater(len(poses(self.out / "trajectory.txt")), FRAMES // 2)
        self.assertEqual(names(maps), {"m.dxmap"})
        self.assertEqual(names(self.folder / "old_maps"), set())  # no lock
        self.assertEqual(names(self.folder / "old_out"), {"trajectory.txt"})

    def test_two_runs_do_not_share_a_folder(self):
        process = self.start_slowly()
        self.refuse(self.run_orb("--out", self.out), str(self.out), "in use by another run")
        self.assertEqual(process.wait(TIMEOUT), 0)
        self.assertEqual(names(self.out), RESULTS)

    def test_a_kill_leaves_both_apart(self):
        self.ends(self.run_orb("--out", self.out), 0)
        before = {name: (self.out / name).read_bytes() for name in names(self.out)}
        for _ in range(2):
            process = self.start_slowly()
            process.kill()
            process.wait(TIMEOUT)
            self.assertTrue(all(len(row) == 8 for row in poses(self.out / "trajectory.txt")))
            self.assertNotIn("summary.json", names(self.out))
            previous = self.out / "previous"
            self.assertEqual({name: (previous / name).read_bytes() for name in names(previous)},
                             before)
        self.ends(self.run_orb("--out", self.out), 0)
        self.assertEqual(names(self.out), RESULTS)

    def test_random_kills(self):
        """No trajectory is lost: the last whole one, or a newer whole one, is always there."""
        self.ends(self.run_orb("--out", self.out), 0)
        whole = len(poses(self.out / "trajectory.txt"))
        source = random.Random(5)
        for _ in range(12):
            process = subprocess.Popen([PROGRAM, "run", self.recording, "--features", "orb", "--out",
                                        self.out], stdout=subprocess.DEVNULL,
                                       stderr=subprocess.DEVNULL, stdin=subprocess.DEVNULL)
            time.sleep(source.uniform(0.02, 0.8))
            process.kill()
            process.wait(TIMEOUT)
            kept = [folder / "trajectory.txt" for folder in
                    (self.out, self.out / "previous", self.out / ".dxslam-previous")]
            counts = [len(poses(file)) for file in kept if file.exists()]
            self.assertGreaterEqual(max(counts), whole - 1)


class FailedOutputs(Outputs):
    def test_targets_are_tried_before_the_first_frame(self):
        folder = self.folder / "folder"
        folder.mkdir()
        photo = self.folder / "photo.jpg"
        photo.write_bytes(b"\xff\xd8 not a map")
        for command in (["run", self.recording], ["lifelong", self.recording]):
            for target in (self.folder / "missing" / "m.dxmap", folder, photo):
                with self.subTest(command=command[0], target=target.name):
                    self.refuse(dxslam(*command, "--features", "orb", "--out", self.out,
                                        "--map-out", target), str(target))
                    self.assertFalse(self.out.exists())
        self.assertEqual(photo.read_bytes(), b"\xff\xd8 not a map")
        self.refuse(self.run_orb("--out", photo), str(photo))

    def test_a_pipe_in_the_place_of_a_result_is_refused(self):
        self.out.mkdir()
        for name, command in {"trajectory.txt": "run", "online_1.txt": "lifelong"}.items():
            os.mkfifo(self.out / name)
            self.refuse(dxslam(command, self.recording, "--features", "orb", "--out", self.out),
                        str(self.out / name), "no regular file")
            (self.out / name).unlink()

    def test_a_map_in_the_place_of_a_result_is_refused(self):
        for command, name in (("run", "map.ply"), ("run", "online_7.txt"),
                              ("lifelong", "lifelong.json"), ("run", "../out/trajectory.txt")):
            self.refuse(dxslam(command, self.recording, "--features", "orb", "--out", self.out,
                               "--map-out", self.out / name), name, "expected another name")
            self.assertFalse(self.out.exists())
        self.ends(self.run_orb("--out", self.out, "--map-out", self.out / "m.dxmap"), 0)
        self.assertEqual(names(self.out), RESULTS | {"m.dxmap"})

    def test_what_can_be_written_is_written_and_all_failures_are_listed(self):
        """The targets become unusable while the program runs."""
        limited = f"ulimit -f 8; exec {PROGRAM} run {self.recording} --features orb --out {self.out} " \
                  f"--map-out {self.folder / 'm.dxmap'} --autosave 1"
        done = subprocess.run(["bash", "-c", limited], capture_output=True, text=True,
                              stdin=subprocess.DEVNULL, timeout=TIMEOUT)
        self.assertEqual(done.returncode, BAD_INPUT, done.stderr)
        lines = done.stderr.splitlines()
        self.assertEqual(sum("autosave" in line for line in lines), 1, done.stderr)
        self.assertTrue(any("map.ply" in line for line in lines), done.stderr)
        self.assertTrue(any("m.dxmap: cannot" in line for line in lines), done.stderr)
        self.assertGreater(len(poses(self.out / "trajectory.txt")), FRAMES // 2)
        self.assertIn("keyframes.txt", names(self.out))
        self.assertFalse((self.folder / "m.dxmap").exists())
        self.assertIn("results, as far as they could be written, in", done.stdout)

    def test_a_failure_is_said_once(self):
        limited = f"ulimit -f 0; exec {PROGRAM} run {self.recording} --features orb --out {self.out}"
        done = subprocess.run(["bash", "-c", limited], capture_output=True, text=True,
                              stdin=subprocess.DEVNULL, timeout=TIMEOUT)
        self.assertEqual(done.returncode, BAD_INPUT, done.stderr)
        about = [line for line in done.stderr.splitlines() if "out/trajectory.txt" in line]
        self.assertEqual(len(about), len(set(about)), done.stderr)
        self.assertLessEqual(len(about), 2, done.stderr)
        self.assertIn("the run goes on", about[0])


class InnerErrors(Outputs):
    """Memory ends for a while: no image can be read or worked on."""

    @staticmethod
    def pages_of(process):
        time.sleep(0.003)
        return int(pathlib.Path(f"/proc/{process.pid}/statm").read_text().split()[0])

    def without_memory_for_a_while(self, poses_file, *command):
        """Runs a command, and takes memory from it once there are some poses; what it says."""
        # Large blocks come from the system each time, so that the limit is felt; small ones do not.
        process = subprocess.Popen([PROGRAM, *map(str, command), "--features", "orb", "--out", self.out],
                                   stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
                                   stdin=subprocess.DEVNULL,
                                   env={**os.environ, "MALLOC_MMAP_THRESHOLD_": "65536",
                                        "MALLOC_TOP_PAD_": "0"})
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        begun = time.monotonic()
        while not poses_file.exists() or len(poses(poses_file)) < FRAMES // 2:
            self.assertIsNone(process.poll(), "the command ended before there were poses")
            self.assertLess(time.monotonic(), begun + TIMEOUT, "no pose appeared")
            time.sleep(0.01)
        seconds_per_image = (time.monotonic() - begun) / (FRAMES // 2)
        pages = min(self.pages_of(process) for _ in range(20))  # when it holds no image
        resource.prlimit(process.pid, resource.RLIMIT_AS,
                         (pages * resource.getpagesize() + ENOUGH_FOR_SMALL_BLOCKS,
                          resource.RLIM_INFINITY))
        time.sleep(max(0.2, 4 * seconds_per_image))  # some images fall into it, on any machine
        resource.prlimit(process.pid, resource.RLIMIT_AS, 2 * (resource.RLIM_INFINITY,))
        said = process.communicate(timeout=TIMEOUT)[1]
        return process.returncode, said

    def test_too_little_memory_is_no_bug(self):
        told = 0
        for megabytes in (100, 120, 140, 200):
            limited = (f"ulimit -v {megabytes * 1024}; exec {PROGRAM} synth {self.out} --force "
                       "--frames 2 --threads 1")
            done = subprocess.run(["bash", "-c", limited], capture_output=True, text=True,
                                  stdin=subprocess.DEVNULL, timeout=TIMEOUT)
            if done.returncode == CANNOT_BE_LOADED:
                continue
            self.assertIn(done.returncode, (0, BAD_INPUT), done.stderr)
            self.assertNotIn("internal error", done.stderr)
            told += "memory" in done.stderr
        self.assertGreater(told, 0)

    def until_it_is_felt(self, poses_file, *command):
        """The same, again where memory came back before anything wanted some."""
        for _ in range(5):
            shutil.rmtree(self.out, ignore_errors=True)
            (self.folder / "m.dxmap").unlink(missing_ok=True)
            code, said = self.without_memory_for_a_while(poses_file, *command, "--map-out",
                                                         self.folder / "m.dxmap")
            if "frames that were skipped: " in said or code == BAD_INPUT:
                break
        # What fails in tracking or mapping ends the run, but all that is whole is saved.
        self.assertNotIn("internal error", said)
        self.assertNotIn("OpenCV(", said)
        if "half changed" not in said:
            self.ends(dxslam("map", "check", self.folder / "m.dxmap"), 0)
        return code, said

    def test_cost_a_run_only_their_images(self):
        code, said = self.until_it_is_felt(self.out / "trajectory.txt", "run", self.recording,
                                           "--realtime")
        summary = self.summary()
        self.assertEqual(names(self.out), RESULTS)
        self.assertGreaterEqual(summary["tracked"], FRAMES // 2)
        if code == BAD_INPUT:
            self.assertIn("memory", summary["error"])
            return
        self.assertIn("frames that were skipped: ", said)
        self.assertGreater(len(summary["skipped_frames"]), 0)
        self.assertIsNone(summary["error"])
        self.assertEqual(code, 0, said)

    def test_cost_lifelong_only_their_images(self):
        code, said = self.until_it_is_felt(self.out / "online_1.txt", "lifelong",
                                           *6 * [self.recording])
        rows = json.loads((self.out / "lifelong.json").read_text())
        for number, row in enumerate(rows, 1):
            self.assertEqual(len(poses(self.out / f"online_{number}.txt")), row["localized"])
        if code == BAD_INPUT:
            self.assertIn("memory", said)
            return
        self.assertEqual(len(rows), 6, said)
        # How much is localized hangs on where memory ended: `orb` finds no place again.
        share = sum(row["localized"] for row in rows) / sum(row["frames"] for row in rows)
        self.assertEqual(code, 0 if share >= LEAST_SHARE else TRACKING_FAILED, said)
        self.assertGreater(sum(row["skipped_frames"] for row in rows), 0)
        for row in rows:  # none is lost without a word
            self.assertGreaterEqual(row["frames"] + row["skipped_frames"], FRAMES, row)


class Told(Outputs):
    def test_calibration_and_depth_are_told(self):
        done = self.ends(self.run_orb("--out", self.out), 0, "calibration.yaml", "units per metre")
        self.assertIn("ATE", done.stdout)
        summary = self.summary()
        self.assertTrue(summary["calibration"].endswith("calibration.yaml"))
        self.assertGreater(summary["depth_factor"], 0)
        self.assertGreater(summary["median_depth_m"], 0.3)
        self.assertGreater(summary["depth_share"], 0.5)
        self.assertLess(summary["ate"]["rmse"], 0.1)
        self.assertAlmostEqual(summary["ate"]["sim3_scale"], 1.0, delta=0.1)

    def test_frames_in_other_maps_count(self):
        elsewhere = self.folder / "elsewhere"
        self.prepare("synth", elsewhere, "--scene", "corridor", "--frames", FRAMES)
        both = self.copy("both")
        for name in ("rgb", "depth"):
            lines = rows_of(both / f"{name}.txt")
            last = float(lines[-1][0])
            for stamp, file in rows_of(elsewhere / f"{name}.txt"):
                shutil.copy(elsewhere / file, both / name / f"of_{pathlib.Path(file).name}")
                lines.append([f"{last + 1 + float(stamp):.6f}", f"{name}/of_{pathlib.Path(file).name}"])
            (both / f"{name}.txt").write_text("".join(f"{a} {b}\n" for a, b in lines))
        (both / "groundtruth.txt").unlink()
        config = self.folder / "soon.yaml"
        config.write_text("new_map_after: 3\n")
        done = self.ends(self.run_orb("--config", config, "--out", self.out, recording=both), 0,
                         "in trajectory_mapN.txt")
        rows = [len(poses(file)) for file in self.out.glob("trajectory*.txt")
                if "online" not in file.name]
        self.assertEqual(len(rows), 2)
        self.assertGreater(min(rows), FRAMES // 2)
        self.assertIn(f"{sum(rows)} of {2 * FRAMES} frames tracked in 2 maps", done.stdout)
        self.assertEqual(self.summary()["tracked"], sum(rows))
        self.assertAlmostEqual(self.summary()["tracked_share"], sum(rows) / (2 * FRAMES))

    def test_images_that_were_left_out_count(self):
        copy = self.copy("same")
        lines = rows_of(copy / "rgb.txt")
        lines[5][0] = lines[6][0] = lines[4][0]
        (copy / "rgb.txt").write_text("".join(f"{stamp} {file}\n" for stamp, file in lines))
        done = self.ends(self.run_orb("--out", self.out, recording=copy), 0)
        self.assertIn(f" of {FRAMES} frames tracked", done.stdout)
        self.assertEqual(self.summary()["frames"], FRAMES)
        self.assertLessEqual(self.summary()["tracked"], FRAMES - 2)

    def test_a_day_without_a_frame_is_told(self):
        elsewhere = self.folder / "elsewhere"
        self.prepare("synth", elsewhere, "--scene", "corridor", "--frames", 10)
        self.ends(dxslam("lifelong", self.recording, elsewhere, "--features", "orb", "--out", self.out),
                  0, "elsewhere: no frame was localized")

    def test_a_wrong_depth_factor_shows(self):
        copy = self.copy()
        file = copy / "calibration.yaml"
        lines = [f"depth_factor: {float(line.split()[1]) / 2}" if line.startswith("depth_factor")
                 else line for line in file.read_text().splitlines()]
        file.write_text("\n".join(lines) + "\n")
        self.ends(self.run_orb("--out", self.out, recording=copy), 0, "depth_factor of")
        self.assertAlmostEqual(self.summary()["ate"]["sim3_scale"], 0.5, delta=0.1)

    def test_names_that_are_not_utf8(self):
        name = os.fsdecode(b"r\xe4um")
        recording = self.folder / name
        shutil.copytree(self.recording, recording)
        self.ends(self.run_orb("--out", self.out, recording=recording), 0)
        self.assertEqual(names(self.out), RESULTS)
        self.assertEqual(self.summary()["sequence"], "r\ufffdum")
        week = self.folder / "week"
        self.ends(dxslam("lifelong", recording, "--features", "orb", "--out", week), 0)
        self.assertEqual(json.loads((week / "lifelong.json").read_text())[0]["sequence"],
                         "r\ufffdum")


if __name__ == "__main__":
    sys.exit(unittest.main())
