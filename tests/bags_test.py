#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The dxslam authors
"""One recording in every container gives the same poses to the bit.

The bags are written by rosbags and mcap (PyPI), which are not ours: .venvs/eval has them. Skips
where that is missing.

usage: bags_test.py [CLASS[.test]]   with $DXSLAM_PROGRAM or build/release/dxslam
"""
import os
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
                whole = self.expected.splitlines()
                self.assertGreater(len(got), FRAMES // 3)
                self.assertEqual([line.split()[0] for line in got],
                                 [line.split()[0] for line in whole[:len(got)]])

    def test_topics_can_be_named(self):
        self.assertEqual(self.poses(self.folder / "bag_two_cameras.mcap", "--color-topic",
                                    "/front/color/image_raw", "--depth-topic",
                                    "/front/depth/image_raw"), self.expected)
        done = dxslam("run", self.folder / "bag_two_cameras.mcap", "--color-topic", "/nosuch")
        self.assertEqual(done.returncode, 3, done.stderr)
        self.assertIn("/front/color/image_raw", done.stderr)


if __name__ == "__main__":
    if not PYTHON.exists() or subprocess.run([PYTHON, "-c", "import rosbags, mcap"],
                                             stderr=subprocess.DEVNULL).returncode:
        print("skipped: .venvs/eval has no rosbags and mcap (scripts/setup --with-eval)")
        sys.exit(SKIPPED)
    sys.exit(unittest.main())
