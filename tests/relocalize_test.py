#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The dxslam authors
"""Runs `dxslam relocalize` as a user does, on a small synthetic recording with the shipped network.

usage: relocalize_test.py [CLASS[.test]]   with $DXSLAM_PROGRAM or build/release/dxslam
"""
import csv
import math
import unittest

from cli_test import TRACKING_FAILED, Recorded, dxslam, poses


class Relocalize(Recorded):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.map = cls.folder / "map.dxm"
        cls.run_folder = cls.folder / "run"
        cls.prepare("run", cls.recording, "--features", "hfnet", "--deterministic", "--out",
                    cls.run_folder, "--map-out", cls.map)

    def relocalize(self, out, *options):
        return dxslam("relocalize", self.map, self.recording, "--features", "hfnet", "--out", out,
                      *options)

    def distances(self, out):
        """Metres between each pose found and the pose of the same frame in the run."""
        tracked = {row[0]: row[1:4] for row in poses(self.run_folder / "trajectory.txt")}
        return [math.dist(tracked[row[0]], row[1:4]) for row in poses(out / "poses.txt")]

    def test_every_frame_is_found_where_the_run_was(self):
        out = self.folder / "found"
        self.succeed(self.relocalize(out))
        distances = self.distances(out)
        with open(out / "relocalization.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), len(poses(self.run_folder / "trajectory.txt")))
        self.assertEqual([row["accepted"] for row in rows], ["1"] * len(rows))
        self.assertEqual(len(distances), len(rows))
        self.assertLess(max(distances), 0.05)
        for row in rows:
            self.assertGreaterEqual(int(row["inliers"]), 22)
            self.assertEqual(int(row["groups_tried"]), 1)
            self.assertGreater(float(row["ms"]), 0.0)

    def test_in_low_light_no_frame_is_found_elsewhere(self):
        out = self.folder / "dark"
        self.succeed(self.relocalize(out, "--low-light", "--stride", 3))
        distances = self.distances(out)
        self.assertGreater(len(distances), 0)
        self.assertLess(max(distances), 0.5)

    def test_a_recording_of_elsewhere(self):
        elsewhere = self.folder / "elsewhere"
        self.prepare("synth", elsewhere, "--scene", "corridor", "--frames", 5, "--seed", 3)
        done = dxslam("relocalize", self.map, elsewhere, "--features", "hfnet")
        self.assertEqual(done.returncode, TRACKING_FAILED, done.stderr)
        self.assertRegex(done.stderr, "no frame was found: at most .* of 5 images")

    def test_true_poses_of_a_recording_are_not_replaced(self):
        out = self.folder / "recording_with_poses"
        out.mkdir()
        (out / "poses.txt").write_text("true poses")
        self.refuse(self.relocalize(out), "poses.txt", "--out")
        self.assertEqual((out / "poses.txt").read_text(), "true poses")

    def test_unusable_maps_are_refused(self):
        no_map = self.folder / "no_map.dxm"
        no_map.write_text("not a map")
        self.refuse(dxslam("relocalize", no_map, self.recording, "--features", "hfnet"), "no_map")
        self.refuse(dxslam("relocalize", self.folder / "missing", self.recording), "missing")
        self.refuse(dxslam("relocalize", self.map, self.recording, "--features", "orb"), "map.dxm")

    def test_a_map_without_global_descriptors_is_refused(self):
        orb_map = self.folder / "orb.dxm"
        self.succeed(self.run_orb(self.folder / "orb", "--map-out", orb_map))
        self.refuse(dxslam("relocalize", orb_map, self.recording, "--features", "orb"),
                    "orb.dxm", "global descriptor")


if __name__ == "__main__":
    unittest.main(verbosity=2)
