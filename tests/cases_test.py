#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The dxslam authors
"""Runs the scripts of $DXSLAM_SHARED/cases/reports, which show faults that users met, and judges what
they print. `EXPECTED` says for each report what its output must hold and must not hold.

usage: cases_test.py [CLASS[.test]]   with $DXSLAM_PROGRAM or build/release/dxslam
"""
import os
import re
import signal
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from cli_test import SLOWER, TIMEOUT

ROOT = Path(__file__).resolve().parent.parent
PROGRAM = os.environ.get("DXSLAM_PROGRAM", str(ROOT / "build" / "release" / "dxslam"))
SHARED = Path(os.environ.get("DXSLAM_SHARED", ROOT.parent / "shared"))
REPORTS = SHARED / "cases" / "reports"
SKIPPED = 77

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
        [rf"{option}; trajectory.txt had (\d+) lines, has \1\n" for option in
         ("--map-in bad.dxmap: exit 3", "--features nosuch: exit 2", "--vocabulary bad.dxmap: exit 3",
          "--map-in nosuch.dxmap: exit 3")], []),
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
    "08-realtime-cannot-be-interrupted": (
        [r"ended [0-4]\.\d s after Ctrl-C", "trajectory.txt", "summary.json"], ["still asleep"]),
    "12-signals-that-save-nothing": (
        [rf"{command} exit 5 " for command in ("run, SIGINT", "run, SIGHUP", "lifelong, SIGINT",
                                               "relocalize, SIGINT", "synth, SIGINT")]
        + ["map of lifelong: True", "stopped before its first frame: exit 5"], []),
    "17-numbers-on-the-command-line": (
        ["--max-frames -1: exit 2", "'-1' is no whole number", "'rnu' is no command, expected run; see",
         "a mistyped command: exit 2", r"--out '' \(an unset variable\): exit 2"], ["0{20}"]),
    "18-output-that-cannot-be-written": (
        ["eval ate > /dev/full: exit 3", "config dump > /dev/full: exit 3",
         "stdout cannot be written: No space left"], ["internal"]),
    "05-cache-folder-cannot-be-made": (
        [r"HOME=/proc: exit 0", r"is a file: exit 0", r"no HOME at all: exit 0",
         r"note: compiled networks are not kept, [^\n]*/proc/\.cache/dxslam"],
        [r"user nobody: exit [1-9]"]),
    "20-silent-fallback-to-orb": (
        [r"exit 3", r"DXSLAM_DATA is /nonexistent, [^\n]*/nonexistent/models/hfnet"], []),
}

TIMED = {"12-signals-that-save-nothing"}
# A crash, an internal error, or a death by a signal (128 + its number).
NEVER = [r"internal error", r"exit 70", r"exit 1[2-9][0-9]", r"exit -[0-9]", r"Segmentation fault",
         r"terminate called"]


def report_names():
    return sorted(path.parent.name for path in REPORTS.glob("*/run.sh"))


class Reports(unittest.TestCase):
    """One test for each report, added below."""


def add_test(name):
    def test(self):
        if name in TIMED and os.environ.get("DXSLAM_SANITIZE"):
            self.skipTest("it stops a program at times that mean others under a sanitizer")
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


class Files(unittest.TestCase):
    """The files of $DXSLAM_SHARED/cases: each is refused in one sentence, and soon."""

    def refuse(self, name, *words, seconds=20 * SLOWER):
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([PROGRAM, *map(str, words)], stdin=subprocess.DEVNULL, cwd=folder,
                                  capture_output=True, text=True, timeout=seconds)
            self.assertEqual(done.returncode, 3, (words, done.stderr))
            said = [line for line in done.stderr.splitlines() if line.startswith("dxslam: ")]
            self.assertEqual(len(said), 1, done.stderr)
            self.assertIn(name, said[0])
            self.assertEqual(os.listdir(folder), [], words)

    def refuse_map(self, name):
        file = SHARED / "cases" / name
        if not file.exists():
            self.skipTest(f"{file} is not there")
        with tempfile.TemporaryDirectory() as folder:
            recording = Path(folder) / "recording"
            subprocess.run([PROGRAM, "synth", recording, "--frames", "5"], check=True,
                           capture_output=True)
            self.refuse(name, "map", "check", file)
            self.refuse(name, "map", "info", file)
            self.refuse(name, "map", "merge", file, file, "--out", "m.dxmap")
            self.refuse(name, "map", "export", file, "--ply", "m.ply")
            self.refuse(name, "relocalize", file, recording)
            for mode in ("slam", "localization"):
                self.refuse(name, "run", recording, "--map-in", file, "--mode", mode)
                self.refuse(name, "lifelong", recording, "--map-in", file, "--mode", mode, "--out",
                            Path(folder) / mode)

    def test_empty_map(self):
        self.refuse_map("empty_map.dxmap")

    def test_huge_pose(self):
        self.refuse_map("huge_pose.dxmap")

    def test_jpeg_scans_bomb(self):
        file = SHARED / "cases" / "jpeg_scans_bomb.jpg"
        if not file.exists():
            self.skipTest(f"{file} is not there")
        self.refuse(file.name, "features", file, "--features", "orb")
        # In a recording it is one bad frame.
        with tempfile.TemporaryDirectory() as folder:
            recording = Path(folder) / "recording"
            subprocess.run([PROGRAM, "synth", recording, "--frames", "8"], check=True,
                           capture_output=True)
            frame = sorted((recording / "rgb").iterdir())[3]
            frame.write_bytes(file.read_bytes())
            done = subprocess.run([PROGRAM, "run", recording, "--features", "orb"], timeout=20 * SLOWER,
                                  stdin=subprocess.DEVNULL, capture_output=True, text=True)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertRegex(done.stderr, f"frames that were skipped: 1; .*{frame.name}")


if __name__ == "__main__":
    if not report_names():
        print(f"skipped: {REPORTS} is not there")
        sys.exit(SKIPPED)
    signal.signal(signal.SIGINT, signal.SIG_DFL)  # where a shell has it ignored, programs would, too
    sys.exit(unittest.main())
