#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The dxslam authors
"""What an odd command line, closed files and few threads do to the program: it refuses in a sentence.

usage: command_line_test.py [CLASS[.test]]   with $DXSLAM_PROGRAM or build/release/dxslam
"""
import os
import resource
import shutil
import tempfile
import unittest

from cli_test import run_tests
from process_test import BAD_INPUT, BAD_USAGE, SUCCESS, Made, program


class CommandLine(Made):
    def refuse(self, *arguments, names=()):
        done = program(*arguments)
        self.expect(done, BAD_USAGE)
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
        self.assertLess(len(done.stderr), 600)
        for name in names:
            self.assertIn(name, done.stderr)

    def test_numbers_out_of_range(self):
        for option, values in {"--max-frames": ["-1", "1.5", "x", "99999999999999999999"],
                               "--stride": ["-1", "0", "nan", "99999999999999999999"],
                               "--autosave": ["0", "-3"],
                               "--low-light=": ["-1", "0", "nan", "inf", "7"]}.items():
            for value in values:
                words = [option + value] if option.endswith("=") else [option, value]
                self.refuse("run", self.recording, *words, names=[option.rstrip("="), value])
        self.refuse("synth", self.folder / "s", "--frames", "-1", names=["--frames", "-1"])
        self.refuse("synth", self.folder / "s", "--fps", "nan", names=["--fps", "nan"])
        self.refuse("eval", "ate", "a", "b", "--max-difference", "nan", names=["nan"])
        self.refuse("bench", "features", self.recording, "--frames", "0")
        self.refuse("features", "a.png", "--max-keypoints", "-5", names=["-5"])
        self.refuse("vocab", "train", self.recording, "--out", "v", "--words", "-1", names=["-1"])
        self.refuse("lifelong", self.recording, "--out", "x", "--low-light-in", "0")
        self.refuse("loops", self.recording, "--method", "orb-bow", "--ground-truth", "poses",
                    "--window", "-1", names=["--window"])
        self.refuse("map", "export", "m", "--ply", "p", "--component", "-1", names=["-1"])
        self.refuse("eval", "rpe", "a", "b", "--delta", "0.5", names=["--delta", "0.5"])

    def test_the_mistyped_word_is_named(self):
        self.refuse("rnu", self.recording, names=["'rnu'", "run"])
        self.refuse("map", "chekc", "m", names=["'chekc'", "check"])
        self.refuse("eval", "xyzzy", names=["'xyzzy'", "ate", "rpe"])
        self.refuse("run", self.recording, "--strid", "2", names=["'--strid'", "expected --stride;"])
        self.refuse("run", self.recording, "--max-frame", "3", names=["'--max-frame'", "--max-frames;"])
        self.refuse("synth", self.folder / "s", "--frames", "1", "--frames", "2",
                    names=["--frames: given more than once"])
        self.refuse("--vresion", names=["'--vresion'", "expected --version;"])
        self.refuse("eval", "foo", names=["'foo'", "see dxslam eval --help"])
        self.refuse("run", self.recording, "another", names=["'another'", "too many"])

    def test_a_mistyped_choice(self):
        map_, run = self.folder / "m", ["run", self.recording]
        for *words, option, value in (
                [*run, "--mode", "foo"], [*run, "--format", "foo"], [*run, "--features", "foo"],
                [*run, "--features", "foo+brief"], ["lifelong", self.recording, "--out", map_, "--mode", "foo"],
                ["relocalize", map_, self.recording, "--format", "foo"],
                ["relocalize", map_, self.recording, "--features", "foo"],
                ["bench", "features", self.recording, "--features", "foo"],
                ["features", "a.png", "--features", "foo"], ["match", "a", "b", "--features", "foo"],
                ["vocab", "train", self.recording, "--out", map_, "--features", "foo"],
                ["loops", "x", "--ground-truth", "poses", "--method", "foo"],
                ["loops", "x", "--method", "orb-bow", "--ground-truth", "poses", "--eye", "foo"],
                ["features", "a.png", "--precision", "foo"], ["match", "a", "b", "--precision", "foo"],
                ["relocalize", map_, self.recording, "--precision", "foo"],
                ["bench", "features", self.recording, "--precision", "foo"],
                ["vocab", "train", self.recording, "--out", map_, "--precision", "foo"],
                ["synth", map_, "--lens", "foo"], ["synth", map_, "--scene", "foo"], ["synth", map_, "--factor", "foo"],
                ["synth", map_, "--factor", "people=foo"], ["config", "dump", "--camera", "foo"],
                ["eval", "ate", "a", "b", "--format", "foo"], ["eval", "ate", "a", "b", "--plot", "foo.png"],
                ["eval", "openloris", "a", "b", "--plot", "foo.PDF"]):
            self.refuse(*words, option, value, names=[option, "foo"])
        self.refuse(*run, "--mode", "localisation", names=["expected localization;"])

    def test_an_empty_value_is_an_unset_variable(self):
        for words in (["run", self.recording, "--out"], ["run", self.recording, "--map-out"],
                      ["run", self.recording, "--map-in"], ["run", self.recording, "--config"],
                      ["run", self.recording, "--calibration"], ["lifelong", "x", "--out"],
                      ["relocalize", "m", self.recording, "--out"], ["eval", "ate", "a", "b", "--json"],
                      ["eval", "ate", "a", "b", "--plot"], ["eval", "ate", "a"],
                      ["eval", "openloris", "a", "b", "--plot"], ["map", "merge", "a", "b", "--out"],
                      ["map", "info", "m", "--json"], ["map", "export", "m", "--ply"],
                      ["features", "i", "--npz"], ["match", "a", "b", "--out"],
                      ["vocab", "train", "x", "--out"], ["vocab", "convert", "a"], ["synth"],
                      ["loops", "x", "--method", "orb-bow", "--ground-truth", "poses", "--out"]):
            self.refuse(*words, "", names=["empty"])
        self.refuse("run", self.recording, "--out=")
        self.refuse("run", self.recording, "--low-light=", names=["--low-light", "empty"])

    def test_names_beyond_the_longest(self):
        name = "n" * 300
        for words in (["run", name], ["run", self.recording, "--out", self.folder / name],
                      ["run", self.recording, "--config", name],
                      ["run", self.recording, "--calibration", name],
                      ["run", self.recording, "--map-in", name],
                      ["run", self.recording, "--map-out", self.folder / name],
                      ["run", self.recording, "--features", name + ".yaml"],
                      ["run", self.recording, "--vocabulary", name],
                      ["run", self.recording, "--association", name],
                      ["lifelong", name, "--out", self.folder / "l"],
                      ["lifelong", self.recording, "--out", self.folder / name],
                      ["relocalize", name, self.recording], ["eval", "ate", name, name],
                      ["eval", "openloris", name, name], ["map", "info", name],
                      ["map", "check", name], ["map", "merge", name, name, "--out", "o" + name],
                      ["features", name], ["match", name, name], ["bench", "features", name],
                      ["vocab", "info", name], ["vocab", "train", name, "--out", "v"],
                      ["vocab", "convert", name, "v"], ["synth", self.folder / name],
                      ["loops", name, "--method", "orb-bow", "--ground-truth", "poses"],
                      ["loops", self.recording, "--method", "orb-bow", "--ground-truth", name]):
            done = program(*words)
            self.assertEqual(done.returncode, BAD_INPUT, (words, done.stderr))
            said = [line for line in done.stderr.splitlines() if line.startswith("dxslam: ")]
            self.assertEqual(len(said), 1, (words, done.stderr))
            self.assertRegex(done.stderr, r"(?i)name too long|no such|no camera|extractor", words)


class UnusedOptions(unittest.TestCase):
    def test_helps_begin_with_small_letters(self):
        for words in ([], ["run"], ["lifelong"], ["info"], ["eval", "ate"], ["eval", "rpe"],
                      ["eval", "openloris"], ["synth"], ["config", "dump"], ["features"], ["match"],
                      ["bench", "features"], ["vocab", "train"], ["vocab", "convert"], ["loops"],
                      ["map", "export"], ["map", "merge"], ["relocalize"], ["record"]):
            for line in program(*words, "--help").stdout.splitlines():
                self.assertNotRegex(line, r"^  \S.*  +[A-Z][a-z]", words)

    def test_options_without_use_are_refused(self):
        common = ["loops", "/nonexistent", "--ground-truth", "truth.txt"]
        for options, named in (
                (["--method", "orb-bow", "--features", "orb"], "--features"),
                (["--method", "orb-bow", "--vocabulary", "v.fbow"], "--vocabulary"),
                (["--method", "global-only", "--orb-vocabulary", "v.fbow"], "--orb-vocabulary"),
                (["--method", "orb-bow", "--radius", "2"], "--radius"),
                (["--method", "orb-bow", "--low-light-gain", "0.1"], "--low-light-gain")):
            done = program(*common, *options)
            self.assertEqual(done.returncode, BAD_INPUT, done.stderr)
            self.assertIn(f"option {named} has no use here", done.stderr)
        for words, named in (
                (["map", "export", "m", "--component", "0", "--colmap", "c"], "--component"),
                (["synth", "/nonexistent/s", "--factor-seed", "1"], "--factor-seed"),
                (["vocab", "train", "r", "--out", "v", "--method", "kmeans", "--matched-per-image", "5"],
                 "--matched-per-image"),
                (["config", "dump", "--camera", "tum_fr1", "--all"], "--all"),
                (["run", "r", "--no-loop-closing", "--vocabulary", "v.fbow"], "--vocabulary"),
                (["run", "r", "--map-in", "m", "--map-out", "n", "--mode", "localization",
                  "--thumbnails"], "--thumbnails"),
                (["lifelong", "r", "--out", "o", "--map-in", "m", "--map-out", "n", "--mode",
                  "localization", "--autosave", "5"], "--autosave")):
            done = program(*words)
            self.assertEqual(done.returncode, BAD_INPUT, (words, done.stderr))
            self.assertIn(f"{named} has no use", done.stderr)
        with tempfile.TemporaryDirectory(prefix="dxslam_unused_") as out:
            done = program("lifelong", "/nonexistent", "--low-light-in", "2", "--out", out)
        self.assertEqual(done.returncode, BAD_INPUT)
        self.assertIn("--low-light-in 2", done.stderr)


class Permissions(Made):
    """As another user, since root may read everything."""

    def setUp(self):
        super().setUp()
        if os.geteuid() != 0:
            self.skipTest("only root can become another user")
        os.chmod(self.root, 0o755)
        os.chmod(self.folder, 0o777)

    def refuse(self, *words):
        done = program(*words, user=65534, group=65534, extra_groups=[], cwd="/")
        self.expect(done, BAD_INPUT)
        self.assertRegex(done.stderr, r"(?i)permission denied")

    def test_what_may_not_be_read(self):
        shutil.copytree(self.recording, self.folder / "r")
        recording = self.folder / "r"
        (recording / "rgb.txt").chmod(0)
        self.refuse("run", recording)
        (recording / "rgb.txt").chmod(0o644)
        recording.chmod(0o600)
        self.refuse("run", recording)
        recording.chmod(0)
        self.refuse("run", recording)
        self.refuse("vocab", "train", recording, "--out", self.folder / "v")
        secret = self.folder / "secret"
        secret.write_text("x")
        secret.chmod(0)
        for words in (["map", "check", secret], ["map", "info", secret], ["vocab", "info", secret],
                      ["eval", "ate", secret, secret], ["features", secret],
                      ["run", self.recording, "--config", secret],
                      ["run", self.recording, "--calibration", secret],
                      ["run", self.recording, "--map-in", secret],
                      ["eval", "openloris", secret, secret]):
            self.refuse(*words)

    def test_what_may_not_be_written(self):
        closed = self.folder / "closed"
        closed.mkdir(0o755)
        self.refuse("run", self.recording, "--features", "orb", "--out", closed)
        self.refuse("run", self.recording, "--features", "orb", "--map-out", closed / "m.dxmap")
        self.refuse("synth", closed / "s")
        blind = self.folder / "blind"
        blind.mkdir()
        blind.chmod(0o333)
        self.refuse("synth", blind)

    def test_few_threads(self):
        # LeakSanitizer wants a thread of its own at the end.
        environment = {**os.environ, "ASAN_OPTIONS": "detect_leaks=0"}
        for threads in (1, 3, 12):
            done = program("synth", self.folder / "s", "--threads", 8, "--frames", 3, "--width", 64,
                           "--height", 48, "--force", user=65534, group=65534, extra_groups=[], cwd="/",
                           env=environment,
                           preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_NPROC,
                                                                 (threads, threads)))
            # Libraries of others may need one; but nothing may die of it.
            self.assertIn(done.returncode, (SUCCESS, BAD_INPUT), done.stderr)
            if done.returncode:
                self.assertRegex(done.stderr, "dxslam: the operating system .*Resource temporarily")


if __name__ == "__main__":
    run_tests()
