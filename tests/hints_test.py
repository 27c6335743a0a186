#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The dxslam authors
"""What the program says of odd input: what is missing, what is likely to be wrong, where and why.

usage: hints_test.py [CLASS[.test]]   with $DXSLAM_PROGRAM or build/release/dxslam
"""
import json
import re
import shutil
import subprocess
import unittest

from cli_test import BAD_INPUT, BAD_USAGE, PROGRAM, TIMEOUT, Recorded, dxslam, poses


class Odd(Recorded):
    frames = 30

    def move_truth(self, recording, scale=1.0, later=0.0):
        text = "\n".join(" ".join(map(str, [row[0] + later, *[scale * v for v in row[1:4]], *row[4:]]))
                         for row in poses(recording / "groundtruth.txt"))
        (recording / "groundtruth.txt").write_text(text + "\n")


class Info(Odd):
    def test_all_files_are_looked_for(self):
        copy = self.copy()
        images = sorted((copy / "rgb").iterdir())
        for image in images[8:]:
            image.unlink()
        images[3].write_bytes(images[3].read_bytes()[:300])
        done = self.succeed(dxslam("info", copy, "--json", self.folder / "info.json"))
        self.assertIn(f"missing: 22 of 30 images are not there; the first: {images[8]}", done.stdout)
        self.assertIn(f"missing: 1 of 8 images looked at cannot be used; the first: {images[3]}",
                      done.stdout)
        self.assertEqual(len(json.loads((self.folder / "info.json").read_text())["missing"]), 2)

    def test_what_run_cannot_read_is_told_by_the_exit_code(self):
        photos = self.folder / "photos"
        shutil.copytree(self.recording / "rgb", photos)
        out = self.folder / "photos.json"
        done = dxslam("info", photos, "--calibration", self.recording / "calibration.yaml",
                      "--json", out)
        self.assertEqual(done.returncode, BAD_INPUT)
        self.assertIn("missing: depth images, which `dxslam run` needs", done.stdout)
        self.assertFalse(json.loads(out.read_text())["usable"])

    def test_the_first_images_may_be_missing(self):
        copy = self.copy()
        for image in sorted((copy / "depth").iterdir())[:10]:
            image.unlink()
        done = self.succeed(self.run_orb(self.folder / "late", recording=copy))
        self.assertIn("frames that were skipped: 10", done.stderr)


class Hints(Odd):
    def test_a_truth_in_millimetres(self):
        copy = self.copy()
        self.move_truth(copy, scale=1000.0)
        done = self.succeed(self.run_orb(self.folder / "mm", recording=copy))
        self.assertIn("is it in millimetres, expected metres?", done.stderr)
        self.assertNotIn("depth_factor of", done.stderr)
        files = copy / "groundtruth.txt", self.folder / "mm" / "trajectory.txt"
        for truth, estimate in (files, files[::-1]):
            done = self.succeed(dxslam("eval", "ate", truth, estimate))
            self.assertIn(f"is {files[0]} in millimetres, expected metres?", done.stderr)

    def test_clocks_that_differ(self):
        copy, out = self.copy(), self.folder / "clock"
        self.move_truth(copy, later=-0.4)
        done = self.succeed(self.run_orb(out, recording=copy))
        self.assertRegex(done.stderr, r"with -0\.[34]\d* s added to the stamps of the images")
        files = copy / "groundtruth.txt", out / "trajectory.txt"
        done = self.succeed(dxslam("eval", "ate", *files, "--max-difference", 0.1))
        self.assertIn("--search-offset 1", done.stderr)
        done = self.succeed(dxslam("eval", "ate", self.recording / "groundtruth.txt", files[1]))
        self.assertEqual(done.stderr, "")

    def test_a_map_of_another_camera(self):
        map_, wrong = self.folder / "m.dxmap", self.folder / "wrong.yaml"
        done = self.succeed(dxslam("run", self.recording, "--features", "orb", "--map-out", map_))
        self.assertIn(f"map in {map_}", done.stdout)
        self.assertNotIn("camera", self.localize(map_, self.recording / "calibration.yaml")
                         .replace("camera of", ""))
        text = (self.recording / "calibration.yaml").read_text()
        wrong.write_text(re.sub(r"(?m)^fx:.*$", "fx: 300", text))
        self.assertRegex(self.localize(map_, wrong), r"m.dxmap: the map was made with another camera "
                         r"\(\d+x\d+, fx .*fx 300.0, .*is the calibration right\?")

    def localize(self, map_, calibration):
        return dxslam("run", self.recording, "--features", "orb", "--map-in", map_, "--calibration",
                      calibration, "--max-frames", 2).stderr


class Messages(Odd):
    def test_one_argument_too_many(self):
        for words, named in ((["map", "check", "a", "b"], "MAP: more than one given, expected one"),
                             (["run", "--", "-s", "--max-frames", "5"],
                              "'--max-frames' is one argument too many"),
                             (["run", "s", "--fly", "--", "x"], "'--fly' is no option")):
            done = dxslam(*words)
            self.assertEqual(done.returncode, BAD_USAGE, done.stderr)
            self.assertIn(named, done.stderr)

    def test_no_sentence_comes_twice(self):
        copy = self.copy()
        (copy / "groundtruth.txt").write_text("1 0 0 0 0 0 0 2\n")
        done = dxslam("loops", copy, "--ground-truth", "poses", "--method", "orb-bow")
        self.assertEqual(done.returncode, BAD_INPUT)
        self.assertEqual(done.stderr.count("quaternion of length 2"), 1, done.stderr)
        self.assertEqual(done.stderr.count("expected --ground-truth with a file"), 1)

    def test_a_map_goes_into_a_pipe(self):
        done = subprocess.run([PROGRAM, "run", self.recording, "--features", "orb", "--max-frames", "5",
                               "--map-out", "/dev/stdout"], stdin=subprocess.DEVNULL,
                              capture_output=True, timeout=TIMEOUT)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn(b"\x89DXMAP\r\n", done.stdout)

    def test_positions_beyond_any_unit(self):
        wild = self.folder / "wild.txt"
        wild.write_text("".join(f"{row[0]} {1e200 * i} 0 {1e200 * i * i} 0 0 0 1\n" for i, row in
                                enumerate(poses(self.recording / "groundtruth.txt"), 1)))
        self.refuse(dxslam("eval", "ate", self.recording / "groundtruth.txt", wild),
                    "wild.txt:1", "1e+200", "expected metres")

    def test_thumbnails_that_a_map_does_not_have(self):
        map_, pictures = self.folder / "bare.dxmap", self.folder / "pictures"
        self.succeed(dxslam("run", self.recording, "--features", "orb", "--max-frames", 5,
                            "--map-out", map_))
        self.refuse(dxslam("map", "export", map_, "--thumbnails", pictures), "no thumbnails",
                    "run --thumbnails")
        self.assertFalse(pictures.exists())


if __name__ == "__main__":
    unittest.main(verbosity=2)
