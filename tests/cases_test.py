#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The dxslam authors
"""Runs the scripts of $DXSLAM_SHARED/cases/reports, which show faults that users met, and judges what
they print. `EXPECTED` says for each report what its output must hold and must not hold.

usage: cases_test.py [CLASS[.test]]   with $DXSLAM_PROGRAM or build/release/dxslam
"""
import os
import re
import subprocess
import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PROGRAM = os.environ.get("DXSLAM_PROGRAM", str(ROOT / "build" / "release" / "dxslam"))
SHARED = Path(os.environ.get("DXSLAM_SHARED", ROOT.parent / "shared"))
REPORTS = SHARED / "cases" / "reports"
SKIPPED = 77
TIMEOUT = 300

# Report: (regular expressions found in its output, regular expressions not found in it).
EXPECTED = {
    "01-nothing-tracked-internal-error": (
        [rf"{kind}, {truth} truth: exit 4, expected 4; trajectory.svg there"
         for kind in ("zero", "black") for truth in ("with", "without")] +
        [r"images without depth: exit 3", r"the same without --out: exit 3",
         r"localization, nothing found: exit 4", r"no depth reading in the first 5 images",
         r"too few keypoints", r"no depth images"], []),
    "02-empty-map-crashes-loader": (
        [r"saving: exit 4", r"map check: exit 3", r"run --map-in: exit 3", r"localization: exit 3",
         r"lifelong --map-in: exit 3", r"map export --colmap: exit 3"], []),
    "03-empty-map-replaces-good-one": (
        [r"the map is empty", r"exit 4; home.dxmap: (\d+) bytes before, \1 after"], []),
    "04-path-not-utf8": (
        [r"folder: exit 0", r"skipped file: exit 0", r"lifelong: exit 0",
         r"summary.json[^-]*---[^-]*summary.json", r"lifelong.json"], []),
    "06-one-failed-output-loses-the-others": (
        [r"--map-out in no folder: exit 3", r"lifelong: exit 3",
         r"no right to mount|disk of --out fills while running: exit 3; map on the good disk: good_",
         r"no right to mount|an autosave fails: exit 3; --out holds:.*summary.json"],
        [r"map on the good disk: none"]),
    "07-mistyped-option-wipes-earlier-result": (
        [rf"{option}: exit 3; trajectory.txt had (\d+) lines, has \1\n" for option in
         ("--map-in bad.dxmap", "--features nosuch", "--vocabulary bad.dxmap",
          "--map-in nosuch.dxmap")], []),
    "15-old-files-stay-in-out": (
        [r"older than this run: *\n", r"one map now, but there is *\n"], []),
    "11-jpeg-with-trailer-refused": (["exit 0"], ["truncated", "none of"]),
    "10-folder-name-picks-wrong-camera": ([r"no calibration", r"--- exit 3"], []),
    "13-file-names-without-leading-zeros": (
        [r"named frame1.jpg, \.\.\.: exit 0\nATE \(m\) +0\.00"], [r"ATE \(m\) +0\.[1-9]"]),
    "14-association-ignored": ([r"--association", r"folder: exit 3",
                                r"--low-light-in 99 of one sequence: exit [23]"], []),
    "19-spaces-bom-and-commas": (
        [r"space in a listed name: exit 0", r"quoted: exit 0", r"decimal comma, expected",
         r"decimal comma: exit 3", r"the same with BOM: exit 0"], []),
    "05-cache-folder-cannot-be-made": (
        [r"HOME=/proc: exit 0", r"is a file: exit 0", r"no HOME at all: exit 0",
         r"note: compiled networks are not kept, [^\n]*/proc/\.cache/dxslam"],
        [r"user nobody: exit [1-9]"]),
    "20-silent-fallback-to-orb": (
        [r"exit 3", r"DXSLAM_DATA is /nonexistent, [^\n]*/nonexistent/models/hfnet"], []),
}

# A crash, an internal error, or a death by a signal (128 + its number).
NEVER = [r"internal error", r"exit 70", r"exit 1[2-9][0-9]", r"exit -[0-9]", r"Segmentation fault",
         r"terminate called"]


def report_names():
    return sorted(path.parent.name for path in REPORTS.glob("*/run.sh"))


class Reports(unittest.TestCase):
    """One test for each report, added below."""


def add_test(name):
    def test(self):
        done = subprocess.run(["bash", REPORTS / name / "run.sh"], stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL, cwd=ROOT,
                              text=True, errors="replace", timeout=TIMEOUT,
                              env={**os.environ, "DXSLAM": PROGRAM, "DXSLAM_SHARED": str(SHARED)})
        wanted, unwanted = EXPECTED.get(name, ([], []))
        for pattern in wanted:
            self.assertRegex(done.stdout, pattern)
        for pattern in [*NEVER, *unwanted]:
            self.assertNotRegex(done.stdout, pattern)

    setattr(Reports, "test_" + re.sub(r"\W", "_", name), test)


for _name in report_names():
    add_test(_name)


if __name__ == "__main__":
    if not report_names():
        print(f"skipped: {REPORTS} is not there")
        sys.exit(SKIPPED)
    sys.exit(unittest.main())
