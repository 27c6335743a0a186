#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The dxslam authors
"""The reader of published poses, benchmarks/published_poses.py, by its file format."""
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "benchmarks"))
from published_poses import write_trajectory  # noqa: E402

HALF = 0.5 ** 0.5
# A quarter turn about z and a shift, camera from world: x' = -y + 1, y' = x + 2, z' = z + 3.
TURNED = f"seq-01/frame-000060.color.png {HALF} 0 0 {HALF} 1 2 3 525.5"
PLAIN = "seq-01/frame-000002.color.png 1 0 0 0 0.5 0 0 525.5"
OTHER = "seq-02/frame-000000.color.png 1 0 0 0 9 9 9 525.5"


class PublishedPoses(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="dxslam_poses_")
        self.addCleanup(folder.cleanup)
        self.file, self.out = Path(folder.name) / "poses.txt", Path(folder.name) / "truth.txt"

    def rows(self, *lines):
        self.file.write_text("\n".join(lines) + "\n")
        write_trajectory(self.file, "seq-01", self.out)
        return [[float(word) for word in line.split()] for line in self.out.read_text().splitlines()]

    def test_writes_world_from_camera_by_rising_stamps(self):
        plain, turned = self.rows(TURNED, OTHER, PLAIN)
        for expected, actual in zip([2 / 30, -0.5, 0, 0, 0, 0, 0, 1], plain, strict=True):
            self.assertAlmostEqual(expected, actual, 6)
        # The centre is where x' = y' = z' = 0: y = 1, x = -2, z = -3.
        for expected, actual in zip([2, -2, 1, -3, 0, 0, -HALF, HALF], turned, strict=True):
            self.assertAlmostEqual(expected, actual, 6)

    def test_refuses_what_is_no_such_file(self):
        with self.assertRaisesRegex(SystemExit, "poses.txt: .*expected the published poses"):
            write_trajectory(self.file, "seq-01", self.out)
        with self.assertRaisesRegex(SystemExit, "poses.txt:2: expected seq-NN/frame"):
            self.rows(PLAIN, "1.0 2.0 3.0")
        with self.assertRaisesRegex(SystemExit, "no pose of seq-01"):
            self.rows(OTHER)


if __name__ == "__main__":
    unittest.main()
