#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The dxslam authors
"""One recording in every container gives the same poses to the bit.

The bags are written by rosbags and mcap (PyPI), which are not ours: .venvs/eval has them. Skips
where that is missing.

usage: bags_test.py [CLASS[.test]]   with $DXSLAM_PROGRAM or build/release/dxslam
"""
import json
import os
import shutil
import sqlite3
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PROGRAM = os.environ.get("DXSLAM_PROGRAM", str(ROOT / "build" / "release" / "dxslam"))
PYTHON = ROOT / ".venvs" / "eval" / "bin" / "python"
WRITER = ROOT / "tests" / "write_bags.py"
SKIPPED = 77
FRAMES = 30
TIMEOUT = 300


def dxslam(*arguments):
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True,
                          stdin=subprocess.DEVNULL, timeout=TIMEOUT)


class Containers(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory(prefix="dxslam_bags_")
        cls.addClassCleanup(folder.cleanup)
        cls.folder = Path(folder.name)
        done = dxslam("synth", cls.folder / "synth", "--frames", FRAMES, "--width", 320, "--height",
                      240)
        if done.returncode:
            raise RuntimeError(done.stderr)
        subprocess.run([PYTHON, WRITER, cls.folder / "synth", cls.folder], check=True,
                       timeout=TIMEOUT)
        cls.expected = cls.poses(cls.folder / "folder")

    @classmethod
    def poses(cls, recording, *options):
        out = cls.folder / ("out_" + recording.name)
        done = dxslam("run", recording, "--features", "orb", "--deterministic", "--out", out, *options)
        if done.returncode:
            raise AssertionError(f"{recording.name}: exit {done.returncode}: {done.stderr}")
        return (out / "trajectory.txt").read_text()

    def test_every_container_gives_the_same_poses(self):
        self.assertEqual(len([line for line in self.expected.splitlines() if line[0] != "#"]),
                         FRAMES)
        bags = sorted(path for path in self.folder.iterdir() if path.name.startswith("bag_"))
        self.assertGreaterEqual(len(bags), 8)
        for bag in bags:
            with self.subTest(bag.name):
                self.assertEqual(self.poses(bag), self.expected)

    def test_a_bag_that_was_cut_off_gives_what_is_whole(self):
        for name in ("bag_plain.bag", "bag_zstd.mcap"):
            with self.subTest(name):
                cut = self.folder / ("cut_" + name)
                cut.write_bytes((self.folder / name).read_bytes()[:-400_000])
                got = self.poses(cut).splitlines()
                said = dxslam("run", cut, "--max-frames", 1, "--features", "orb").stderr
                self.assertEqual(said.count(f"{cut}: cut off"), 1, said)
                self.assertNotIn(f"{cut}: {cut}", said)
                whole = self.expected.splitlines()
                self.assertGreater(len(got), FRAMES // 3)
                self.assertEqual([line.split()[0] for line in got],
                                 [line.split()[0] for line in whole[:len(got)]])

    def test_the_journal_of_a_killed_recorder_is_read(self):
        source, work, killed = (self.folder / name for name in ("bag_sqlite", "journal", "killed"))
        work.mkdir()
        killed.mkdir()
        file = next(source.glob("*.db3"))
        shutil.copy(file, work)
        database = sqlite3.connect(work / file.name)
        rows = database.execute("SELECT * FROM messages WHERE id > 45").fetchall()
        database.execute("DELETE FROM messages WHERE id > 45")
        database.commit()
        database.execute("PRAGMA journal_mode=WAL")
        database.executemany(f"INSERT INTO messages VALUES ({','.join('?' * len(rows[0]))})", rows)
        database.commit()
        for part in work.iterdir():
            if not part.name.endswith("-shm"):
                shutil.copy(part, killed)
        database.close()
        self.assertEqual(len(list(killed.iterdir())), 2, "the file and its journal")
        self.assertEqual(self.poses(killed), self.expected)

    def test_topics_can_be_named(self):
        self.assertEqual(self.poses(self.folder / "bag_two_cameras.mcap", "--color-topic",
                                    "/front/color/image_raw", "--depth-topic",
                                    "/front/depth/image_raw"), self.expected)
        done = dxslam("run", self.folder / "bag_two_cameras.mcap", "--color-topic", "/nosuch")
        self.assertEqual(done.returncode, 3, done.stderr)
        self.assertIn("/front/color/image_raw", done.stderr)

    def test_info_tells_what_is_in_a_recording(self):
        out = self.folder / "info.json"
        for name, topics in (("bag_zstd.mcap", 3), ("bag_sqlite", 3), ("folder", 0)):
            with self.subTest(name):
                done = dxslam("info", self.folder / name, "--json", out)
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertIn("missing: nothing", done.stdout)
                told = json.loads(out.read_text())
                self.assertEqual(len(told["topics"]), topics)
                self.assertEqual(told["frames"]["count"], FRAMES)
                self.assertEqual((told["camera"]["width"], told["camera"]["height"]), (320, 240))
                self.assertEqual(told["missing"], [])
        done = dxslam("info", ROOT / "tests" / "data" / "bags" / "zstd.mcap", "--json", out)
        self.assertEqual(done.returncode, 3, done.stderr)
        self.assertIn("zstd.mcap: /camera/color/camera_info: camera height is 12", done.stdout)
        self.assertFalse(json.loads(out.read_text())["usable"])

    def test_every_command_takes_a_bag(self):
        bag, out = self.folder / "bag_zstd.mcap", self.folder / "out_commands"
        for words in (["lifelong", bag, self.folder / "bag_sqlite", "--features", "orb", "--out", out],
                      ["bench", "features", bag, "--features", "orb", "--frames", 2],
                      ["vocab", "train", f"{bag}@0:20", "--features", "orb", "--words", 50,
                       "--out", self.folder / "words.fbow"]):
            with self.subTest(words[0]):
                done = dxslam(*words)
                self.assertEqual(done.returncode, 0, done.stderr)


if __name__ == "__main__":
    if not PYTHON.exists() or subprocess.run([PYTHON, "-c", "import rosbags, mcap"],
                                             stderr=subprocess.DEVNULL).returncode:
        print("skipped: .venvs/eval has no rosbags and mcap (scripts/setup --with-eval)")
        sys.exit(SKIPPED)
    sys.exit(unittest.main())
