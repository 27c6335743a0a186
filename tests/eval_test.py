#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The dxslam authors
"""Runs `dxslam eval` as a user does.

usage: eval_test.py [CLASS[.test]]   with $DXSLAM_PROGRAM or build/release/dxslam
"""
import json
import math
import os
import re
import resource
import subprocess
import tempfile
import unittest
from pathlib import Path

from cli_test import BAD_INPUT, PROGRAM, TIMEOUT, dxslam, poses


class Trajectories(unittest.TestCase):
    """Files of `dxslam eval`, without any recording."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="dxslam_eval_")
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def write(self, name, rows):
        (self.folder / name).write_text("\n".join(rows) + "\n")
        return self.folder / name

    @staticmethod
    def row(t, late=0.0):
        return (f"{t + late:.4f} {math.sin(t):.6f} {math.cos(2 * t):.6f} {0.3 * math.sin(3 * t):.6f}"
                " 0 0 0 1")

    def walk(self, late=0.0, count=300):
        return (self.row(0.02 * i, late) for i in range(count))

    def test_poses_without_stamps_belong_together_by_number(self):
        rows = [f"1 0 0 {math.sin(0.1 * i):.6f} 0 1 0 {math.cos(0.2 * i):.6f} 0 0 1 {0.1 * i:.6f}"
                for i in range(50)]
        kitti = self.write("kitti.txt", rows)
        done = dxslam("eval", "ate", kitti, kitti)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("50 of 50 estimated poses matched", done.stdout)
        done = dxslam("eval", "ate", kitti, kitti, "--max-difference", "1")
        self.assertEqual(done.returncode, BAD_INPUT)
        self.assertIn("--max-difference", done.stderr)
        done = dxslam("eval", "ate", kitti, self.write("short.txt", rows[1:]))
        self.assertEqual(done.returncode, BAD_INPUT)
        self.assertIn("49", done.stderr)

    def test_offset_of_clocks_is_found(self):
        truth = self.write("truth.txt", self.walk())
        late = self.write("late.txt", self.walk(late=0.3125))
        report = self.folder / "report.json"
        done = dxslam("eval", "ate", truth, late, "--search-offset", "1", "--json", report)
        self.assertEqual(done.returncode, 0, done.stderr)
        found = json.loads(report.read_text())
        self.assertAlmostEqual(found["time_offset_s"], -0.3125, delta=0.001)
        self.assertLess(found["position"]["rmse"], 0.002)

    def test_an_offset_between_the_stamps_asks_for_a_larger_difference(self):
        truth = self.write("truth.txt", list(self.walk(count=600))[::10])  # every 0.2 s
        # Halfway between, once the offset is taken away.
        late = self.write("late.txt", [self.row(0.2 * i + 0.1, late=0.5) for i in range(55)])
        done = dxslam("eval", "ate", truth, late, "--search-offset", "1")
        self.assertEqual(done.returncode, BAD_INPUT, done.stderr)
        wider = re.search(r"expected --max-difference ([0-9.]+)", done.stderr)
        self.assertTrue(wider, done.stderr)
        done = dxslam("eval", "ate", truth, late, "--search-offset", "1", "--max-difference", wider[1])
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_a_stamp_that_comes_again_stands_for_one_pose(self):
        rows = list(self.walk())
        twice = self.write("twice.txt", [row for i in range(0, 300, 3) for row in
                                         (rows[i], rows[i].split()[0] + " 9 9 9 0 0 0 1")])
        done = dxslam("eval", "ate", twice, twice)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("100 of 200 poses have the stamp of the one before", done.stderr)
        self.assertRegex(done.stdout, r"ATE \(m\) +0\.000000")

    def test_motions_over_more_than_there_is(self):
        truth = self.write("truth.txt", self.walk())
        done = dxslam("eval", "rpe", truth, truth, "--delta", "1e9")
        self.assertEqual(done.returncode, BAD_INPUT, done.stderr)
        self.assertIn("no two of the 300 matched poses are 1e+09 frames apart", done.stderr)

    @unittest.skipIf(os.environ.get("DXSLAM_SANITIZE"), "sanitizers reserve terabytes of addresses")
    def test_large_files_take_memory_by_their_poses_only(self):
        rows = [f"{i} 0.123456789 0.234567891 0.345678912 0 0 0 1.000000000" for i in range(400000)]
        for i in range(100):
            rows[i] = f"{i} {i} {i * i} {(7 * i) % 13} 0 0 0 1"
        large = self.write("large.txt", rows)

        def limit():
            resource.setrlimit(resource.RLIMIT_DATA, (500 << 20, 500 << 20))

        done = subprocess.run([PROGRAM, "eval", "ate", large, large], capture_output=True, text=True,
                              timeout=TIMEOUT, preexec_fn=limit, stdin=subprocess.DEVNULL)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("400000 of 400000", done.stdout)


if __name__ == "__main__":
    unittest.main(verbosity=2)
