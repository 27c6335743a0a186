#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The dxslam authors
"""`dxslam loops` as a user runs it, on a synthetic recording. $DXSLAM_PROGRAM is the program."""
import csv
import json
import shutil
import unittest

from cli_test import BAD_USAGE, Recorded, dxslam

FRAMES = 40


class Loops(Recorded):
    frames = FRAMES

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.words = cls.folder / "orb.fbow"
        cls.prepare("vocab", "train", cls.recording, "--method", "kmeans", "--words", 200,
                    "--features", "orb", "--out", cls.words)

    def loops(self, *options, recording=None, truth="poses", method="orb-bow", words=None):
        return dxslam("loops", recording or self.recording, "--ground-truth", truth, "--method",
                      method, "--orb-vocabulary", words or self.words, "--window", 0.3,
                      *(["--radius", 0.5] if truth == "poses" else []), *options)

    def test_writes_candidates_curve_and_summary(self):
        out = self.folder / "one"
        self.succeed(self.loops("--out", out))
        summary = json.loads((out / "summary.json").read_text())
        self.assertEqual(summary["method"], "orb-bow")
        self.assertEqual(summary["queries"], FRAMES)
        self.assertGreater(summary["queries_with_loop"], 10)
        self.assertGreater(summary["average_precision"], 0.9)  # the same corner all along
        self.assertGreater(summary["median_query_ms"], 0.0)
        rows = list(csv.DictReader((out / "candidates.csv").read_text().splitlines()))
        self.assertEqual(list(rows[0])[:5],
                         ["query", "match", "bow_score", "global_distance", "accepted"])
        lines = (self.recording / "rgb.txt").read_text().splitlines()
        stamps = [float(line.split()[0]) for line in lines if line[0] != "#"]
        for row in rows:
            age = stamps[int(row["query"])] - stamps[int(row["match"])]
            self.assertGreater(age, 0.3 - 1e-6)
        curve = list(csv.DictReader((out / "pr.csv").read_text().splitlines()))
        full = [float(p["recall"]) for p in curve if p["wrong"] == "0"]
        self.assertAlmostEqual(max(full, default=0.0), summary["recall_at_100_precision"], 5)
        self.assertTrue((out / "pr.svg").read_text().startswith("<svg"))

    def test_judges_several_methods_at_once(self):
        out = self.folder / "two"
        self.succeed(self.loops("--out", out, method="orb-bow,orb-bow+geometry"))
        summaries = json.loads((out / "summary.json").read_text())
        self.assertEqual([s["method"] for s in summaries], ["orb-bow", "orb-bow+geometry"])
        rows = csv.DictReader((out / "orb-bow+geometry" / "candidates.csv").read_text().splitlines())
        self.assertTrue(all(int(row["inliers"]) >= 0 for row in rows))

    def test_keeps_two_passes_apart(self):
        out = self.folder / "passes"
        self.succeed(self.loops("--second-pass-from", 25, "--low-light-from", 25, "--out", out))
        rows = list(csv.DictReader((out / "candidates.csv").read_text().splitlines()))
        self.assertTrue(rows)
        for row in rows:
            self.assertGreaterEqual(int(row["query"]), 25)
            self.assertLess(int(row["match"]), 25)
        self.assertEqual(json.loads((out / "summary.json").read_text())["places"], 25)

    def test_without_a_true_loop_there_is_no_recall(self):
        matrix = self.folder / "none.txt"
        rows = [["1" if (i, j) == (FRAMES - 1, 0) else "0" for j in range(FRAMES)] for i in range(FRAMES)]
        matrix.write_text("\n".join(" ".join(row) for row in rows) + "\n")
        out = self.folder / "no_loop"
        done = self.succeed(self.loops("--out", out, "--max-frames", FRAMES // 2, truth=matrix))
        self.assertIn("no query has a true loop", done.stderr)
        self.assertNotIn("0.0000", done.stdout)
        summary = json.loads((out / "summary.json").read_text())
        for key in ("recall_at_100_precision", "average_precision"):
            self.assertIsNone(summary[key])
        self.assertFalse(summary["interrupted"])
        rows = csv.DictReader((out / "pr.csv").read_text().splitlines())
        self.assertEqual({row["recall"] for row in rows} | {""}, {""})

    def test_takes_plain_images_and_a_matrix(self):
        images = self.folder / "images_only"
        images.mkdir()
        for number, file in enumerate(sorted((self.recording / "rgb").iterdir())):
            shutil.copy(file, images / f"{number:04}{file.suffix}")
        matrix = self.folder / "truth.txt"
        rows = [["1" if i - j >= 20 else "0" for j in range(FRAMES)] for i in range(FRAMES)]
        matrix.write_text("\n".join(" ".join(row) for row in rows) + "\n")
        out = self.folder / "matrix"
        self.succeed(self.loops("--out", out, recording=images, truth=matrix))
        self.assertEqual(json.loads((out / "summary.json").read_text())["queries_with_loop"], 20)
        # A matrix of both cameras' images serves for one of them.
        self.succeed(self.loops("--eye", "left", "--out", out, recording=images, truth=matrix))
        self.assertEqual(json.loads((out / "summary.json").read_text())["queries"], FRAMES // 2)

    def test_says_what_does_not_fit(self):
        done = self.loops(method="orb-bag")
        self.assertEqual(done.returncode, BAD_USAGE, done.stderr)
        for text in ("'orb-bag'", "hf-bow-global"):
            self.assertIn(text, done.stderr)
        self.refuse(self.loops(words=self.folder / "none.fbow"), "none.fbow")
        matrix = self.folder / "small.txt"
        matrix.write_text("0 0\n1 0\n")
        self.refuse(self.loops(truth=matrix), "small.txt", "2 frames", f"{FRAMES}")
        done = self.loops("--angle", 500)
        self.assertEqual(done.returncode, BAD_USAGE, done.stderr)
        self.assertIn("180", done.stderr)
        self.assertEqual(dxslam("loops", self.recording).returncode, BAD_USAGE)


if __name__ == "__main__":
    unittest.main()
