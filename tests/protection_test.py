#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The dxslam authors
"""No command replaces what it reads, a file of another kind, or another of its own outputs.

usage: protection_test.py [CLASS[.test]]   with $DXSLAM_PROGRAM or build/release/dxslam
"""
import json
import shutil
import subprocess
import sys
import time
import unittest

from cli_test import BAD_INPUT, INTERRUPTED, PROGRAM, TIMEOUT, TRACKING_FAILED, Recorded, dxslam, \
    poses

PRECIOUS = b"precious\n"


class Kept(Recorded):
    frames = 30

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.map = cls.folder / "m.dxmap"
        cls.results = cls.folder / "results"
        cls.prepare("run", cls.recording, "--features", "orb", "--thumbnails", "--out", cls.results,
                    "--map-out", cls.map)
        cls.estimate = cls.results / "trajectory.txt"
        cls.truth = cls.recording / "groundtruth.txt"
        cls.photos = sorted((cls.recording / "rgb").iterdir())[:3]

    def setUp(self):
        self.folder = type(self).folder / self.id().split(".")[-1]
        self.folder.mkdir()

    def keeps(self, file, *command, said=()):
        """A command that is refused, and does not touch the file."""
        before = file.read_bytes()
        self.refuse(dxslam(*command), *said)
        self.assertEqual(file.read_bytes(), before)


class Files(Kept):
    def commands(self):
        """Those with a file to write: what comes before its name."""
        truth_and_estimate = [self.truth, self.estimate]
        return {
            "recording": ["info", self.recording, "--json"],
            "info": ["map", "info", self.map, "--json"],
            "ply": ["map", "export", self.map, "--ply"],
            "merge": ["map", "merge", self.map, self.map, "--out"],
            "ate json": ["eval", "ate", *truth_and_estimate, "--json"],
            "ate plot": ["eval", "ate", *truth_and_estimate, "--plot"],
            "rpe json": ["eval", "rpe", *truth_and_estimate, "--json"],
            "openloris json": ["eval", "openloris", *truth_and_estimate, "--json"],
            "openloris plot": ["eval", "openloris", *truth_and_estimate, "--plot"],
            "match": ["match", *self.photos[:2], "--features", "orb", "--out"],
            "bench": ["bench", "features", self.recording, "--features", "orb", "--frames", 1, "--json"],
            "run": ["run", self.recording, "--features", "orb", "--map-out"],
        }

    def test_files_of_other_kinds(self):
        for name, command in self.commands().items():
            ending = {"match": ".jpg"}.get(name, ".svg" if "plot" in name else ".txt")
            file = self.folder / f"mine{ending}"
            file.write_bytes(PRECIOUS)
            with self.subTest(name):
                self.keeps(file, *command, file, said=(str(file), "not replaced"))

    def test_inputs(self):
        commands = self.commands()
        for name, file in (("info", self.map), ("ply", self.map), ("ate json", self.truth),
                           ("rpe json", self.estimate), ("match", self.photos[1]),
                           ("merge", self.map)):
            with self.subTest(name):
                self.keeps(file, *commands[name], file, said=(str(file), "an input of this command"))
        link = self.folder / "link.json"
        link.symlink_to(self.estimate)
        self.keeps(self.estimate, *commands["ate json"], link, said=("an input of this command",))

    def test_its_own_kind_is_replaced(self):
        for name, command in self.commands().items():
            if "openloris" in name:
                continue
            ending = {"match": ".png"}.get(name, ".svg" if "plot" in name else ".any")
            file = self.folder / f"{name.replace(' ', '_')}{ending}"
            file.write_bytes(b"")
            with self.subTest(name):
                for _ in range(2):
                    self.assertEqual(dxslam(*command, file).returncode, 0)
                    self.assertGreater(file.stat().st_size, 0)

    def test_a_photo_is_no_picture_of_match(self):
        match = ["match", *self.photos[:2], "--features", "orb", "--out"]
        photo = self.folder / f"holiday{self.photos[2].suffix}"
        shutil.copy(self.photos[2], photo)
        self.keeps(photo, *match, photo, said=("holiday", "is not replaced"))
        picture = self.folder / "picture.jpg"
        for _ in range(2):
            self.succeed(dxslam(*match, picture))

    def test_two_outputs_of_one_name(self):
        same = self.folder / "same.svg"
        again = self.folder / "." / "same.svg"
        for metric in ("ate", "openloris"):
            self.refuse(dxslam("eval", metric, self.truth, self.estimate, "--json", same, "--plot",
                               again), "--plot", "the file of --json")
        self.assertFalse(same.exists())

    def test_a_picture_has_the_name_of_one(self):
        self.refuse(dxslam("match", *self.photos[:2], "--features", "orb", "--out",
                           self.folder / "m.txt"), ".png")

    def test_one_output_that_fails_costs_no_other(self):
        plot = self.folder / "ok.svg"
        table = self.folder / "table.json"
        command = ["eval", "ate", self.truth, self.estimate, "--json", self.folder / "no" / "a.json",
                   "--plot", plot]
        self.refuse(dxslam(*command), "no/a.json")
        # What a full disk does to the larger of two.
        limited = f"ulimit -f 1; exec {PROGRAM} eval ate {self.truth} {self.estimate} --json {table} " \
                  f"--plot {plot}"
        done = subprocess.run(["bash", "-c", limited], capture_output=True, text=True,
                              stdin=subprocess.DEVNULL, timeout=TIMEOUT)
        self.assertEqual(done.returncode, BAD_INPUT, done.stderr)
        self.assertIn("ok.svg: cannot be written", done.stderr)
        self.assertTrue(table.exists())

    def test_features(self):
        copies = self.folder / "photos"
        copies.mkdir()
        for name, photo in zip("abc", self.photos):
            shutil.copy(photo, copies / f"{name}{photo.suffix}")
        images = sorted(copies.iterdir())
        out = self.folder / "npz"
        out.mkdir()
        mine = out / "b.npz"
        mine.write_bytes(PRECIOUS)
        self.keeps(mine, "features", *images, "--features", "orb", "--npz", out, said=("b.npz",))
        self.assertEqual([path.name for path in out.iterdir()], ["b.npz"])
        mine.unlink()
        images[1].write_bytes(PRECIOUS)  # no image
        for _ in range(2):
            done = dxslam("features", *images, "--features", "orb", "--npz", out)
            self.assertEqual(done.returncode, BAD_INPUT)
            self.assertIn(images[1].name, done.stderr)
            self.assertEqual(sorted(path.name for path in out.iterdir()), ["a.npz", "c.npz"])

    def test_exports(self):
        pictures = self.folder / "pictures"
        self.succeed(dxslam("map", "export", self.map, "--thumbnails", pictures))
        picture = min(path.name for path in pictures.iterdir())
        for command, name in (("--colmap", "0/images.txt"), ("--thumbnails", picture),
                              ("--colmap", "0/cameras.txt")):
            out = self.folder / name.replace("/", "_")
            file = out / name
            file.parent.mkdir(parents=True)
            file.write_bytes(b"\xff\xd8\xff\xe0 a photo" if name.endswith("jpg") else PRECIOUS)
            with self.subTest(name):
                self.keeps(file, "map", "export", self.map, command, out, said=(name,))
                file.unlink()
                for _ in range(2):
                    self.succeed(dxslam("map", "export", self.map, command, out))


class Folders(Kept):
    def test_files_of_others_under_the_names_of_results(self):
        run = ["run", self.recording, "--features", "orb", "--out"]
        loops = ["loops", self.recording, "--ground-truth", "poses", "--method", "orb-bow", "--out"]
        for name, command in (("trajectory.txt", run), ("map.ply", run), ("summary.json", run),
                              ("dxslam_notes.txt", run), ("previous", run), ("pr.csv", loops)):
            out = self.folder / name
            out.mkdir()
            (out / name).write_bytes(PRECIOUS)
            with self.subTest(name):
                self.keeps(out / name, *command, out, said=(str(out / name),))
                self.assertEqual([path.name for path in out.iterdir()], [name])
        # A trajectory, but of another program.
        other = self.folder / "other"
        other.mkdir()
        (other / "trajectory.txt").write_text("1.0 0 0 0 0 0 0 1\n")
        self.keeps(other / "trajectory.txt", *run, other, said=("trajectory.txt",))

    def test_results_of_another_command(self):
        self.keeps(self.results / "summary.json", "loops", self.recording, "--ground-truth", "poses",
                   "--method", "orb-bow", "--out", self.results, said=("summary.json",))

    def test_a_map_of_the_name_of_the_folder(self):
        both = self.folder / "both"
        self.refuse(dxslam("run", self.recording, "--features", "orb", "--out", both, "--map-out", both),
                    "--map-out", "--out")
        self.assertFalse(both.exists())

    def test_two_runs_do_not_save_one_map(self):
        target = self.folder / "m.dxmap"
        out = self.folder / "out"
        first = subprocess.Popen([PROGRAM, "run", self.recording, "--features", "orb", "--realtime",
                                  "--out", out, "--map-out", target], stdout=subprocess.DEVNULL,
                                 stderr=subprocess.DEVNULL, stdin=subprocess.DEVNULL)
        self.addCleanup(first.wait)
        self.addCleanup(first.kill)
        deadline = time.monotonic() + TIMEOUT
        while not (out / "trajectory.txt").exists():
            self.assertIsNone(first.poll())
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.01)
        link = self.folder / "link.dxmap"
        link.symlink_to(target)
        for name in (target, link):
            self.refuse(dxslam("run", self.recording, "--features", "orb", "--map-out", name),
                        str(name), "another process")
        self.refuse(dxslam("map", "merge", self.map, self.map, "--out", target), "another process")
        self.assertEqual(first.wait(TIMEOUT), 0)
        self.assertGreater(len(poses(out / "trajectory.txt")), 0)  # a slow machine drops many
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()),
                         ["link.dxmap", "m.dxmap", "out"])
        self.succeed(dxslam("run", self.recording, "--features", "orb", "--map-out", target))


class EndsBadly(Kept):
    """A run that does not end with 0 costs neither the last results nor the last map."""

    def setUp(self):
        super().setUp()
        self.out = self.folder / "out"
        self.saved = self.folder / "m.dxmap"
        shutil.copytree(self.results, self.out)
        shutil.copy(self.map, self.saved)
        self.previous = self.folder / "m.dxmap.previous"

    def command(self, *words):
        return [*words, "--features", "orb", "--out", self.out, "--map-out", self.saved]

    def check_kept(self, said):
        before = {path.name: path.read_bytes() for path in self.results.iterdir()}
        kept = {path.name: path.read_bytes() for path in (self.out / "previous").iterdir()}
        self.assertEqual(kept, before)
        self.assertEqual(self.previous.read_bytes(), self.map.read_bytes())
        self.assertIn(f"the results of before are kept in {self.out / 'previous'}", said)
        self.assertIn(f"the map of before is kept as {self.previous}", said)

    def stop(self, *command, poses_file):
        """Stops a command once it has some poses; returns what it says."""
        begun = time.time_ns()
        process = subprocess.Popen([PROGRAM, *map(str, command)], stdout=subprocess.DEVNULL,
                                   stderr=subprocess.PIPE, stdin=subprocess.DEVNULL, text=True)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        deadline = time.monotonic() + TIMEOUT
        while (not poses_file.exists() or poses_file.stat().st_mtime_ns < begun or
               len(poses(poses_file)) < 3):
            self.assertIsNone(process.poll(), "it ended before it was stopped")
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.01)
        process.terminate()
        said = process.communicate(timeout=TIMEOUT)[1]
        self.assertEqual(process.returncode, INTERRUPTED, said)
        return said

    def broken(self):
        """A recording with two images that can be read."""
        broken = self.folder / "broken"
        shutil.copytree(self.recording, broken)
        for image in sorted((broken / "rgb").iterdir())[2:]:
            image.write_bytes(b"no image")
        return broken

    def check_ended_well(self):
        self.succeed(dxslam(*self.command("run", self.recording)))
        self.assertFalse((self.out / "previous").exists())
        self.assertFalse(self.previous.exists())
        self.succeed(dxslam("map", "check", self.saved))

    def test_a_run_that_is_stopped(self):
        for _ in range(2):
            self.check_kept(self.stop(*self.command("run", self.recording, "--realtime", "--autosave", 1),
                                      poses_file=self.out / "trajectory.txt"))
            self.assertLess(len(poses(self.out / "trajectory.txt")), self.frames)
            self.succeed(dxslam("map", "check", self.saved))
        self.check_ended_well()

    def test_lifelong_that_is_stopped(self):
        self.check_kept(self.stop(*self.command("lifelong", *20 * [self.recording]),
                                  poses_file=self.out / "online_1.txt"))
        rows = json.loads((self.out / "lifelong.json").read_text())
        self.assertEqual([row["interrupted"] for row in rows], (len(rows) - 1) * [False] + [True])

    def test_a_run_that_tracks_too_little(self):
        broken = self.broken()
        for _ in range(2):
            done = dxslam(*self.command("run", broken))
            self.assertEqual(done.returncode, TRACKING_FAILED, done.stderr)
            self.check_kept(done.stderr)
        self.check_ended_well()

    def test_a_map_that_is_gone_on_with(self):
        done = dxslam(*self.command("run", self.broken(), "--map-in", self.saved))
        self.assertEqual(done.returncode, TRACKING_FAILED, done.stderr)
        self.assertFalse(self.previous.exists())
        self.succeed(dxslam("map", "check", self.saved))


if __name__ == "__main__":
    sys.exit(unittest.main())
