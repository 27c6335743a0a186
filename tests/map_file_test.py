#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The dxslam authors
"""Map files as a user meets them: saved by a run, looked at, merged, exported, damaged, and saved
by a process that is killed.

usage: map_file_test.py [CLASS[.test]]   with $DXSLAM_PROGRAM or build/release/dxslam
"""
import json
import math
import os
import random
import re
import shutil
import signal
import subprocess
import sys
import time
import unittest

from cli_test import BAD_USAGE, PROGRAM, ROOT, Recorded, dxslam

FIRST_VERSION = ROOT / "tests" / "data" / "map_v1.dxmap"
FRAMES = 40
KILLS = 40


class Saved(Recorded):
    """Tests that share the maps of two parts of one small synthetic recording."""

    frames = FRAMES

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.first, cls.second = cls.folder / "first.dxmap", cls.folder / "second.dxmap"
        for file, frames in ((cls.first, FRAMES), (cls.second, FRAMES // 2)):
            cls.prepare("run", cls.recording, "--features", "orb", "--max-frames", frames,
                        "--map-out", file, "--out", cls.folder / f"{file.stem}_run")

    def info(self, file):
        report = self.folder / "info.json"
        self.succeed(dxslam("map", "info", file, "--json", report))
        return json.loads(report.read_text())


class Commands(Saved):
    def test_info_says_what_the_run_said(self):
        summary = json.loads((self.folder / "first_run" / "summary.json").read_text())
        report = self.info(self.first)
        self.assertEqual(report["keyframes"], summary["keyframes"])
        self.assertEqual(report["points"], summary["points"])
        self.assertEqual(report["features"], "orb")
        self.assertEqual(report["descriptors"]["kind"], "binary")
        self.assertEqual(report["bytes"], self.first.stat().st_size)
        self.assertEqual(len(report["components"]), 1)
        self.assertLess(report["reprojection_error_px"]["median"], 1.5)

    def test_info_of_a_float_map_in_words(self):
        text = self.succeed(dxslam("map", "info", FIRST_VERSION)).stdout
        for line in (r"features +sample, 32 floats per keypoint, weights a{12}$",
                     r"component 1 +2 keyframes", r"section GLOB +version 1"):
            self.assertRegex(text, re.compile(line, re.M))

    def test_check_finds_nothing_wrong(self):
        text = self.succeed(dxslam("map", "check", self.first)).stdout
        self.assertRegex(text, r"checksums +right")
        self.assertRegex(text, r"behind camera 0 ")
        self.assertRegex(text, r"1 group of covisible keyframes in 1 component\n")

    def test_merged_maps_lie_side_by_side(self):
        out = self.folder / "merged.dxmap"
        self.succeed(dxslam("map", "merge", self.first, self.second, self.first, "--apart", "--out",
                            out))
        parts = [self.info(file) for file in (self.first, self.second, self.first)]
        merged = self.info(out)
        for key in ("keyframes", "points", "observations", "keypoints"):
            self.assertEqual(merged[key], sum(part[key] for part in parts), key)
        self.assertEqual([c["keyframes"] for c in merged["components"]],
                         [part["keyframes"] for part in parts])
        self.assertEqual(merged["components"][1], parts[1]["components"][0])

    def test_maps_of_one_place_are_joined(self):
        out = self.folder / "joined.dxmap"
        text = self.succeed(dxslam("map", "merge", self.first, self.second, "--out", out)).stdout
        self.assertRegex(text, "in 1 component;")
        parts, joined = [self.info(file) for file in (self.first, self.second)], self.info(out)
        self.assertEqual(joined["keyframes"], sum(part["keyframes"] for part in parts))
        self.assertLess(joined["points"], sum(part["points"] for part in parts))
        self.assertGreater(joined["loops"], 0)
        self.assertLess(joined["reprojection_error_px"]["median"], 1.5)
        self.assertRegex(self.succeed(dxslam("map", "check", out)).stdout,
                         "1 group of covisible keyframes in 1 component\n")

    def test_merging_onto_an_input_is_refused(self):
        out, other = self.folder / "self.dxmap", self.folder / "other.dxmap"
        shutil.copy(self.second, out)
        os.link(out, other)
        before = out.read_bytes()
        for name in (out, other):
            self.refuse(dxslam("map", "merge", self.first, out, "--out", name), name,
                        "an input of this command")
        self.assertEqual(out.read_bytes(), before)

    def test_ply_holds_points_and_keyframes(self):
        ply = self.folder / "map.ply"
        self.succeed(dxslam("map", "export", self.first, "--ply", ply))
        header = ply.read_bytes().split(b"end_header\n")[0].decode()
        report = self.info(self.first)
        self.assertIn(f"element vertex {report['points'] + report['keyframes']}\n", header)

    def test_thumbnails_are_those_of_the_keyframes(self):
        """Made on demand, kept when the map grows without them, and written out by name."""
        first, grown = self.folder / "pictures.dxmap", self.folder / "grown.dxmap"
        recording = self.folder / "recording"
        for out, options in ((first, ["--thumbnails", "--max-frames", FRAMES // 2]),
                             (grown, ["--map-in", first])):
            self.succeed(dxslam("run", recording, "--features", "orb", "--map-out", out, *options))
        report = self.info(first)
        self.assertEqual(report["thumbnails"], report["keyframes"])
        self.assertGreater(self.info(grown)["thumbnails"], 0)
        self.assertEqual(self.info(self.first)["thumbnails"], 0)
        folder = self.folder / "colmap_pictures"
        self.succeed(dxslam("map", "export", first, "--colmap", folder))
        names = re.findall(r" 1 (\S+)\.png$", (folder / "0" / "images.txt").read_text(), re.M)
        pictures = sorted((folder / "0" / "thumbnails").iterdir())
        self.assertEqual([picture.stem for picture in pictures], sorted(names))
        for picture in pictures:
            data = picture.read_bytes()
            self.assertEqual((data[:2], data[-2:]), (b"\xff\xd8", b"\xff\xd9"))
            self.assertLess(len(data), 20000)

    def test_thumbnails_need_a_map_to_be_put_into(self):
        self.refuse(dxslam("run", self.folder / "recording", "--thumbnails"), "--map-out")

    def test_colmap_model_is_consistent(self):
        folder = self.folder / "colmap"
        self.succeed(dxslam("map", "export", self.first, "--colmap", folder))
        cameras, images, points = (
            [line for line in (folder / "0" / name).read_text().splitlines()
             if not line.startswith("#")]
            for name in ("cameras.txt", "images.txt", "points3D.txt"))
        model, width, height, *parameters = cameras[0].split()[1:]
        self.assertEqual(model, "PINHOLE")
        fx, fy, cx, cy = map(float, parameters)
        poses, keypoints = {}, {}
        for head, body in zip(images[::2], images[1::2]):
            fields = head.split()
            poses[fields[0]] = [float(field) for field in fields[1:8]]
            values = body.split()
            keypoints[fields[0]] = list(zip(map(float, values[::3]), map(float, values[1::3]),
                                            values[2::3]))
        report = self.info(self.first)
        self.assertEqual(len(poses), report["keyframes"])
        self.assertEqual(len(points), report["points"])
        errors = []
        for line in points:
            point, *fields = line.split()
            position = [float(field) for field in fields[:3]]
            track = fields[7:]
            for image, index in zip(track[::2], track[1::2]):
                x, y, seen = keypoints[image][int(index)]
                self.assertEqual(seen, point)
                u, v, z = in_camera(poses[image], position)
                errors.append(math.hypot(fx * u / z + cx - x, fy * v / z + cy - y))
        errors.sort()
        self.assertEqual(len(errors), report["observations"])
        self.assertAlmostEqual(errors[len(errors) // 2],
                               report["reprojection_error_px"]["median"], delta=0.01)

    def test_bad_usage(self):
        for words in (["map"], ["map", "info"], ["map", "fly", self.first],
                      ["map", "merge", self.first, "--out", "x"], ["map", "export", self.first]):
            self.assertEqual(dxslam(*words).returncode, BAD_USAGE, words)


def in_camera(pose, point):
    """World to camera by COLMAP's quaternion (w x y z) and translation."""
    w, x, y, z, *translation = pose
    rows = ((1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
            (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
            (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)))
    return [sum(a * b for a, b in zip(row, point)) + t for row, t in zip(rows, translation)]


class Refusals(Saved):
    def refuse_map(self, file, *mentioned):
        for command in (["info", file], ["check", file], ["merge", self.first, file, "--out",
                        self.folder / "never"], ["export", file, "--ply", self.folder / "never"]):
            self.refuse(dxslam("map", *command), file.name, *mentioned)
        self.assertFalse((self.folder / "never").exists())

    def test_missing_file(self):
        self.refuse_map(self.folder / "nowhere.dxmap", "no such file")

    def test_another_kind_of_file(self):
        self.refuse_map(self.folder / "recording" / "groundtruth.txt", "is no dxslam map")

    def test_cut_and_altered_files(self):
        whole = self.first.read_bytes()
        broken = self.folder / "broken.dxmap"
        broken.write_bytes(whole[:len(whole) // 2])
        self.refuse_map(broken, "cut short")
        broken.write_bytes(whole[:5000] + bytes([whole[5000] ^ 1]) + whole[5001:])
        self.refuse_map(broken, "does not match its checksum")
        broken.write_bytes(b"")
        self.refuse_map(broken, "is no dxslam map")

    def test_maps_of_other_features_are_not_merged(self):
        self.refuse(dxslam("map", "merge", self.first, FIRST_VERSION, "--out",
                           self.folder / "never"), "`sample`", "`orb`", "cannot be compared")

    def test_a_map_of_other_features_is_not_used(self):
        self.refuse(dxslam("run", self.folder / "recording", "--features", "orb", "--map-in",
                           FIRST_VERSION, "--out", self.folder / "out"),
                    "map_v1.dxmap", "`sample`", "`orb`")

    def test_component_that_is_not_there(self):
        self.refuse(dxslam("map", "export", self.first, "--component", 1, "--ply",
                           self.folder / "never"), "no component 1")

    def test_folder_that_is_not_there(self):
        self.refuse(dxslam("map", "merge", self.first, self.second, "--out",
                           self.folder / "no" / "map"), "cannot be written")


class Killed(Saved):
    def test_the_old_or_the_new_map_is_whole(self):
        """The program, killed at any moment; map_file_kill_test.cpp kills a saver in a loop."""
        out = self.folder / "out.dxmap"
        orders = [(self.first, self.second), (self.second, self.first)]
        expected = []
        for order in orders:
            start = time.monotonic()
            self.succeed(dxslam("map", "merge", *order, "--apart", "--out", out))
            duration = time.monotonic() - start
            expected.append(out.read_bytes())
        self.assertNotEqual(*expected)
        random.seed(1)
        for i in range(KILLS):
            process = subprocess.Popen([PROGRAM, "map", "merge", *map(str, orders[i % 2]), "--apart",
                                        "--out", str(out)], stdout=subprocess.DEVNULL)
            time.sleep(random.uniform(0.2, 1.1) * duration)
            process.send_signal(signal.SIGKILL)
            process.wait()
            self.assertIn(out.read_bytes(), expected, f"kill {i}")
        self.succeed(dxslam("map", "check", out))
        self.succeed(dxslam("map", "merge", *orders[0], "--apart", "--out", out))
        self.assertEqual(list(self.folder.glob("out.dxmap.*")), [], "left behind by the killed")


if __name__ == "__main__":
    sys.exit(unittest.main())
