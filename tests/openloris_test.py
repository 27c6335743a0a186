#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The dxslam authors
"""Runs `dxslam eval openloris` as a user does.

usage: openloris_test.py [CLASS[.test]]   with $DXSLAM_PROGRAM or build/release/dxslam
"""
import json
import math
import sys
import tempfile
import unittest
from pathlib import Path
from xml.etree import ElementTree

from cli_test import BAD_INPUT, BAD_USAGE, dxslam


def rows(begin, seconds, offset=0.0):
    """Poses along a curve, ten a second."""
    lines = []
    for i in range(round(10 * seconds) + 1):
        t = 0.1 * i
        x, y = 2 * math.cos(t), math.sin(2 * t) + offset
        lines.append(f"{begin + t:.6f} {x:.9f} {y:.9f} {0.1 * t:.9f} 0 0 0 1\n")
    return "".join(lines)


class Openloris(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="dxslam_openloris_")
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.truth = self.write("gt_home_1.txt",
                                "scene: home\nframe: base_link\n\nseq: 1\n" + rows(0, 20) +
                                "seq: 2\n" + rows(100, 10))
        self.result = self.write("ours_home.txt",
                                 "scene: home\nframe: base_link\nseq: 1\n" + rows(0, 20, 7.0) +
                                 "seq: 2\n" + rows(105, 5, 50.0))

    def write(self, name, text):
        file = self.folder / name
        file.write_text(text)
        return file

    def test_figures(self):
        file = self.folder / "figures.json"
        done = dxslam("eval", "openloris", self.truth, self.result, "--json", file)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("correct within 3 m and 30 degrees", done.stdout)
        result = json.loads(file.read_text())["results"][0]
        self.assertEqual(result["scene"], "home")
        first, second = result["sequences"]
        self.assertAlmostEqual(first["correct_rate"], 1.0)
        self.assertAlmostEqual(first["ate_m"]["rmse"], 0.0, places=6)
        self.assertAlmostEqual(first["relocalization_score"], 1.0)
        self.assertAlmostEqual(second["tracked_rate"], 0.5, places=5)
        self.assertEqual(second["correct_rate"], 0.0)
        self.assertEqual(second["relocalization_score"], 0.0)
        self.assertAlmostEqual(result["correct_rate"], 2 / 3, places=5)
        self.assertEqual(result["c_ate_m"], first["c_ate_m"]["rmse"])

    def test_thresholds(self):
        file = self.folder / "figures.json"
        done = dxslam("eval", "openloris", self.truth, self.result, "--max-position", "inf",
                      "--json", file)
        self.assertEqual(done.returncode, 0, done.stderr)
        result = json.loads(file.read_text())["results"][0]
        self.assertIsNone(result["max_position_m"])
        self.assertAlmostEqual(result["sequences"][1]["relocalization_score"],
                               math.exp(-5 / 60), places=5)

    def test_picture_of_several_results_with_a_folder_of_truths(self):
        self.write("gt_cafe_1.txt", "scene: cafe\nframe: base_link\nseq: 1\n" + rows(0, 10))
        cafe = self.write("ours_cafe.txt", "scene: cafe\nframe: base_link\nseq: 1\n" + rows(0, 10))
        other = self.write("other_home.txt", "scene: home\nframe: base_link\nseq: 1\n")
        picture = self.folder / "picture.svg"
        done = dxslam("eval", "openloris", self.folder, self.result, cafe, other, "--plot", picture)
        self.assertEqual(done.returncode, 0, done.stderr)
        texts = [t.text for t in ElementTree.parse(picture).getroot().iter()
                 if t.tag.endswith("text")]
        for text in ("home", "cafe", "ours", "other", "66.7 %", "100.0 %", "0.0 %"):
            self.assertIn(text, texts)
        self.assertEqual(texts.count("ours"), 1)

    def test_absent_sequences_are_told(self):
        result = self.write("part.txt", "scene: home\nframe: base_link\nseq: 1\n" + rows(0, 20))
        done = dxslam("eval", "openloris", self.truth, result)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("counted as never localized: seq 2; without them correct is 1.000", done.stdout)

    def test_unusable_files_are_refused_in_one_line(self):
        unknown = self.write("unknown.txt", "scene: home\nframe: nose\nseq: 1\n" + rows(0, 9))
        broken = self.write("broken.txt", "scene: home\nframe: base_link\nseq: 1\n1 2 3\n")
        other = self.write("other.txt", "scene: cafe\nframe: base_link\nseq: 1\n" + rows(0, 9))
        for file, mentioned in ((unknown, "'nose'"), (broken, "broken.txt:4"), (other, "cafe"),
                                (self.folder / "none.txt", "none.txt")):
            done = dxslam("eval", "openloris", self.truth, file)
            self.assertEqual(done.returncode, BAD_INPUT, done.stderr)
            self.assertEqual(len(done.stderr.strip().splitlines()), 1, done.stderr)
            self.assertIn(mentioned, done.stderr)

    def test_bad_usage(self):
        for words in ([], [self.truth], [self.truth, self.result, "--max-angle", "-1"]):
            self.assertEqual(dxslam("eval", "openloris", *words).returncode, BAD_USAGE, words)


if __name__ == "__main__":
    unittest.main(verbosity=1, argv=sys.argv)
