# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The dxslam authors
"""The programs of examples/python do what they say. $DXSLAM_EXAMPLES or beside the tests."""
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

import dxslam
import recording

EXAMPLES = Path(os.environ.get("DXSLAM_EXAMPLES")
                or Path(__file__).parents[2] / "examples" / "python")


def call(name, *arguments):
    return subprocess.run([sys.executable, EXAMPLES / name, *map(str, arguments)],
                          capture_output=True, text=True, timeout=300)


class Examples(unittest.TestCase):
    def must(self, *command):
        done = call(*command)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def test_run_slam_and_find_image(self):
        with tempfile.TemporaryDirectory() as folder:
            trajectory, map_file = Path(folder) / "trajectory.txt", Path(folder) / "map.dxmap"
            said = self.must("run_slam.py", recording.PATH, trajectory, map_file)
            count = len(recording.images())
            self.assertRegex(said, rf"\d+ of {count} images tracked")
            self.assertRegex(said, r"trajectory error [01]\.\d cm")
            poses = dxslam.Trajectory.read(trajectory)
            said = self.must("find_image.py", map_file, recording.PATH, 20)
            where = [float(word) for word in said.split()[3:6]]
            expected = poses.positions[np.argmin(np.abs(poses.stamps - recording.images()[20][0]))]
            self.assertLess(np.abs(where - expected).max(), 0.03)

    def test_watch(self):
        said = self.must("watch.py", recording.PATH)
        self.assertRegex(said, r"\d+ images tracked, \d+ points, 0 events missed")

    def test_they_tell_their_usage_and_what_is_wrong(self):
        for name, arguments in (("run_slam.py", 2), ("find_image.py", 2), ("watch.py", 1)):
            self.assertIn("usage: " + name, call(name).stderr)
            done = call(name, *["/nothing/here"] * arguments)
            self.assertEqual(done.returncode, 1)
            self.assertRegex(done.stderr, r"^\w+: /nothing/here: no such file")


if __name__ == "__main__":
    unittest.main()
