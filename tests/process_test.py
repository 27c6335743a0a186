#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The dxslam authors
"""What a console that fails and a signal do to the program: nothing is lost.

usage: process_test.py [CLASS[.test]]   with $DXSLAM_PROGRAM or build/release/dxslam
"""
import json
import os
import shutil
import signal
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

from cli_test import TIMEOUT, run_tests

ROOT = Path(__file__).resolve().parent.parent
PROGRAM = os.environ.get("DXSLAM_PROGRAM", str(ROOT / "build" / "release" / "dxslam"))
SUCCESS, BAD_USAGE, BAD_INPUT, INTERRUPTED = 0, 2, 3, 5
FRAMES = 40
SECONDS_TO_STOP = 2.0 * 2.5  # the promise, and room for machines busy with other tests (CONTRIBUTING)


def contents(folder):
    """The files in a folder, which need not be there."""
    return {path.name: path.read_bytes() for path in folder.glob("*") if path.is_file()}


def program(*arguments, **options):
    return subprocess.run([PROGRAM, *map(str, arguments)], stdin=subprocess.DEVNULL, timeout=TIMEOUT,
                          **{"capture_output": "stdout" not in options, "text": True,
                             "errors": "replace", **options})


def shell(command, folder):
    """A command line of bash, in which $D is the program."""
    return subprocess.run(["bash", "-c", command], cwd=folder, env={**os.environ, "D": PROGRAM},
                          stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=TIMEOUT)


def rows(file):
    return [line.split() for line in file.read_text().splitlines() if not line.startswith("#")]


class Made(unittest.TestCase):
    """A recording for all tests of a class, and a folder for each test."""

    @classmethod
    def setUpClass(cls):
        cls.root = Path(tempfile.mkdtemp(prefix="dxslam_process_"))
        cls.recording = cls.root / "recording"
        made = program("synth", cls.recording, "--frames", FRAMES, "--width", 320, "--height", 240)
        assert made.returncode == 0, made.stderr

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.root, ignore_errors=True)

    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(dir=self.root))

    def expect(self, done, code):
        self.assertEqual(done.returncode, code, (done.stdout, done.stderr))

    def check_results(self, out, map_file=None):
        """Whole results of the recording, and nothing else in them."""
        for row in rows(out / "trajectory.txt"):
            self.assertEqual(len(row), 8, row)
        self.assertEqual(len(rows(out / "trajectory.txt")), FRAMES)
        json.loads((out / "summary.json").read_text())
        if map_file:
            self.expect(program("map", "check", map_file), SUCCESS)


class Console(Made):
    RUN = '"$D" run ../recording --features orb --out out --map-out m.dxmap'

    def check_run(self, redirection, code=SUCCESS):
        done = shell(f"{self.RUN} {redirection}", self.folder)
        self.expect(done, code)
        self.check_results(self.folder / "out", self.folder / "m.dxmap")
        return done

    def test_stdout_on_a_full_disk(self):
        done = self.check_run("> /dev/full", BAD_INPUT)
        self.assertRegex(done.stderr, r"dxslam: stdout cannot be written: No space left")
        estimate = self.folder / "out" / "trajectory.txt"
        for command in (f'"$D" eval ate ../recording/groundtruth.txt {estimate}', '"$D" config dump',
                        '"$D" --help', '"$D" map info m.dxmap'):
            done = shell(f"{command} > /dev/full", self.folder)
            self.expect(done, BAD_INPUT)
            self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)

    def test_stderr_on_a_full_disk(self):
        self.check_run("2> /dev/full")

    def test_closed_descriptors(self):
        self.check_run(">&- 2>&-")
        self.check_run("2>&-")
        self.check_run("<&- >&- 2>&-")

    def test_reader_that_went_away(self):
        # The reader of both ends at once.
        done = shell(f'{{ {self.RUN} 2>&1; echo $? > code; }} | true', self.folder)
        self.expect(done, SUCCESS)
        self.assertEqual((self.folder / "code").read_text().strip(), "0")
        self.check_results(self.folder / "out", self.folder / "m.dxmap")

    def test_stderr_that_nobody_reads(self):
        reading, writing = os.pipe()
        os.set_blocking(writing, False)
        try:
            while True:
                os.write(writing, b"x" * 4096)
        except BlockingIOError:
            pass
        os.set_blocking(writing, True)
        out = self.folder / "out"
        done = program("run", self.recording, "--features", "orb", "--out", out,
                       stdout=subprocess.DEVNULL, stderr=writing)
        os.close(reading)
        os.close(writing)
        self.expect(done, SUCCESS)
        self.check_results(out)

    def test_names_cannot_command_the_terminal(self):
        done = program("run", "a\x1b[2J\nb")
        self.expect(done, BAD_INPUT)
        self.assertIn("a\\x1b[2J\\nb", done.stderr)
        self.assertNotIn("\x1b", done.stderr)
        done = program("a\x1b[2Jb")
        self.expect(done, BAD_USAGE)
        self.assertNotIn("\x1b", done.stderr)
        estimate = self.folder / "x\x1b[31m.txt"
        shutil.copy(self.recording / "groundtruth.txt", estimate)
        done = program("eval", "ate", self.recording / "groundtruth.txt", estimate)
        self.expect(done, SUCCESS)
        self.assertNotIn("\x1b", done.stdout + done.stderr)

    def test_json_to_stdout_stands_beside_the_rest(self):
        done = shell('"$D" config dump > all; cd ..; "$D" eval ate recording recording/groundtruth.txt'
                     f' --json /dev/stdout > {self.folder}/all', self.folder)
        self.expect(done, SUCCESS)
        text = (self.folder / "all").read_text()
        self.assertIn("ATE (m)", text)
        self.assertIn('"metric": "ate"', text)


# Loaded into the program, it makes opening a file whose name holds "slow" take a minute, as a dead
# network drive would. A file, $SLOW_SIGN, says that this has begun.
SLOW_DISK = r"""
#define _GNU_SOURCE
#include <dlfcn.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
static void wait_for(const char* path) {
  if (!path || !strstr(path, "slow")) return;
  close(creat(getenv("SLOW_SIGN"), 0600));
  sleep(60);
}
FILE* fopen64(const char* path, const char* mode) {
  FILE* (*real)(const char*, const char*) = (FILE* (*)(const char*, const char*))dlsym(RTLD_NEXT, "fopen64");
  wait_for(path);
  return real(path, mode);
}
int open(const char* path, int flags, ...) {
  int (*real)(const char*, int, ...) = (int (*)(const char*, int, ...))dlsym(RTLD_NEXT, "open");
  va_list rest;
  va_start(rest, flags);
  int mode = flags & (O_CREAT | __O_TMPFILE) ? va_arg(rest, int) : 0;
  va_end(rest);
  wait_for(path);
  return real(path, flags, mode);
}
"""


def cpu_seconds(process):
    """Of a process that lives; 0 before it began."""
    fields = Path(f"/proc/{process.pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


class Signals(Made):
    """Every command ends soon, with 5, and with all saved that was made."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.long = cls.root / "long"
        made = program("synth", cls.long, "--frames", 300, "--width", 320, "--height", 240)
        assert made.returncode == 0, made.stderr
        made = program("run", cls.recording, "--map-out", cls.root / "m.dxmap")
        assert made.returncode == 0, made.stderr
        # After a few frames nothing comes for a minute.
        cls.gap = cls.root / "gap"
        shutil.copytree(cls.recording, cls.gap)
        for name in ("rgb.txt", "depth.txt"):
            lines = [f"{float(stamp) + (60 if i > 10 else 0):.6f} {file}"
                     for i, (stamp, file) in enumerate(rows(cls.gap / name))]
            (cls.gap / name).write_text("\n".join(lines) + "\n")

    def start(self, *words, **options):
        said = tempfile.TemporaryFile(dir=self.folder)
        self.addCleanup(said.close)
        process = subprocess.Popen([PROGRAM, *map(str, words)], stdin=subprocess.DEVNULL,
                                   **{"stdout": subprocess.DEVNULL, "stderr": said, **options})
        process.said = said
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def await_work(self, process, seconds):
        """Waits until the process has worked so long."""
        deadline = time.monotonic() + TIMEOUT
        while cpu_seconds(process) < seconds:
            self.assertIsNone(process.poll(), "it ended before it was stopped")
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.01)

    def await_sign(self, process, seen):
        deadline = time.monotonic() + TIMEOUT
        while not seen():
            self.assertIsNone(process.poll(), "it ended before it was stopped")
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.02)

    def await_poses(self, process, out):
        file = out / "trajectory.txt"
        self.await_sign(process, lambda: file.exists() and len(rows(file)) > 1)

    def await_rest(self, process):
        """Waits until the process does nothing."""
        before = -1.0
        while cpu_seconds(process) > before:
            before = cpu_seconds(process)
            time.sleep(0.3)

    def stop(self, process, *signals):
        begun = time.monotonic()
        for number in signals or [signal.SIGTERM]:
            process.send_signal(number)
            time.sleep(0.05)
        self.assertEqual(process.wait(TIMEOUT), INTERRUPTED)
        self.assertLess(time.monotonic() - begun, SECONDS_TO_STOP)
        process.said.seek(0)
        self.assertEqual(process.said.read().count(b"stopped by a signal"), 1)

    def start_with_gap(self, out, **options):
        process = self.start("run", self.gap, "--features", "orb", "--realtime", "--out", out,
                             "--map-out", out.with_suffix(".dxmap"), **options)
        self.await_poses(process, out)
        self.await_rest(process)  # it waits for the image after the gap
        return process

    def check_interrupted(self, out):
        self.assertTrue(json.loads((out / "summary.json").read_text())["interrupted"])
        self.assertGreater(len(rows(out / "trajectory.txt")), 0)
        self.expect(program("map", "check", out.with_suffix(".dxmap")), SUCCESS)

    def test_run_that_waits_for_the_next_image(self):
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            out = self.folder / number.name
            self.stop(self.start_with_gap(out), number)
            self.check_interrupted(out)

    def test_many_signals_lose_nothing(self):
        out = self.folder / "out"
        self.stop(self.start_with_gap(out), *[signal.SIGINT, signal.SIGHUP, signal.SIGTERM] * 3)
        self.check_interrupted(out)

    def test_what_is_ignored_by_request(self):
        # SIGHUP is what nohup does, SIGINT what a shell does that runs it behind.
        for ignored, other in ((signal.SIGHUP, signal.SIGTERM), (signal.SIGINT, signal.SIGTERM),
                               (signal.SIGTERM, signal.SIGINT)):
            out = self.folder / ignored.name
            process = self.start_with_gap(
                out, preexec_fn=lambda: signal.signal(ignored, signal.SIG_IGN))
            process.send_signal(ignored)
            time.sleep(0.5)
            self.assertIsNone(process.poll(), f"{ignored.name} should be ignored")
            self.stop(process, other)
            self.check_interrupted(out)

    def test_run_before_its_first_frame(self):
        out = self.folder / "out"
        self.expect(program("run", self.recording, "--features", "orb", "--out", out), SUCCESS)
        before = contents(out)
        for delay in (0.0, 0.02, 0.05, 0.1):
            process = self.start("run", self.long, "--features", "orb", "--out", out)
            time.sleep(delay)
            process.send_signal(signal.SIGTERM)
            # Not even the program's own first steps were made, or 5.
            self.assertIn(process.wait(TIMEOUT), (INTERRUPTED, -signal.SIGTERM))
            if json.loads((out / "summary.json").read_text())["tracked"] > 0:  # it was slow to die
                before = contents(out)
            self.assertIn(before, (contents(out), contents(out / "previous")))

    def test_slow_disk(self):
        compiler = shutil.which("cc") or shutil.which("gcc")
        library = self.root / "slow_disk.so"
        (self.root / "slow_disk.c").write_text(SLOW_DISK)
        if not compiler or subprocess.run([compiler, "-shared", "-fPIC", "-w", "-o", library,
                                           self.root / "slow_disk.c", "-ldl"]).returncode:
            self.skipTest("no C compiler")
        recording = self.folder / "recording"
        shutil.copytree(self.recording, recording)
        lines = (recording / "rgb.txt").read_text().splitlines()
        name = lines[25].split()[1]
        shutil.move(recording / name, recording / "rgb" / "slow.jpg")
        (recording / "rgb.txt").write_text("\n".join(lines).replace(name, "rgb/slow.jpg") + "\n")
        sign = self.folder / "sign"
        preload = {"env": {**os.environ, "LD_PRELOAD": str(library), "SLOW_SIGN": str(sign)}}
        if program("--version", **preload).returncode:
            self.skipTest("the program takes no preloaded library")
        out = self.folder / "out"
        process = self.start("run", recording, "--features", "orb", "--out", out, "--map-out",
                             out.with_suffix(".dxmap"), **preload)
        self.await_sign(process, sign.exists)
        self.await_poses(process, out)
        self.stop(process)
        sign.unlink()
        self.check_interrupted(out)
        found = self.folder / "found"
        process = self.start("relocalize", self.root / "m.dxmap", recording, "--out", found, **preload)
        self.await_sign(process, sign.exists)
        self.stop(process)
        self.assertGreater(len((found / "relocalization.csv").read_text().splitlines()), 1)

    def test_lifelong(self):
        out, saved = self.folder / "out", self.folder / "m.dxmap"
        process = self.start("lifelong", *[self.long] * 5, "--features", "orb", "--out", out,
                             "--map-out", saved)
        self.await_work(process, 2.0)
        self.stop(process)
        self.assertGreater(len(json.loads((out / "lifelong.json").read_text())), 0)
        self.expect(program("map", "check", saved), SUCCESS)

    def test_relocalize(self):
        out = self.folder / "out"
        command = ["relocalize", self.root / "m.dxmap"]
        self.expect(program(*command, self.recording, "--stride", 10, "--out", out), SUCCESS)
        before = contents(out)
        process = self.start(*command, self.long, "--out", out)
        self.await_work(process, 1.2)
        self.stop(process)
        self.assertGreater(len((out / "relocalization.csv").read_text().splitlines()), 1)
        self.assertTrue((out / "poses.txt").exists())
        self.assertEqual(contents(out / "previous"), before)

    def test_synth(self):
        out = self.folder / "made"
        process = self.start("synth", out, "--frames", "2000")
        self.await_work(process, 2.0)
        self.stop(process)
        # What was drawn is a recording.
        self.expect(program("run", out, "--features", "orb"), SUCCESS)
        self.expect(program("synth", out, "--frames", "5", "--force", "--width", 64, "--height", 48),
                    SUCCESS)

    def test_loops(self):
        out = self.folder / "out"
        methods = ["--ground-truth", "poses", "--method", "orb-bow,orb-bow+geometry", "--out", out]
        self.expect(program("loops", self.recording, *methods), SUCCESS)
        before = contents(out), contents(out / "orb-bow")
        process = self.start("loops", self.long, *methods)
        self.await_work(process, 0.4)
        self.stop(process)
        for summary in json.loads((out / "summary.json").read_text()):
            self.assertGreater(summary["queries"], 0)
            self.assertTrue(summary["interrupted"])
        previous = out / "previous"
        self.assertEqual((contents(previous), contents(previous / "orb-bow")), before)

    def test_vocabulary(self):
        checkpoint, out = self.folder / "checkpoint", self.folder / "v.fbow"
        # Five times the same: long enough to be stopped in the middle of it.
        words = ["vocab", "train", *[self.long] * 5, "--features", "orb", "--out", out,
                 "--checkpoint", checkpoint, "--stride", 2]
        process = self.start(*words)
        self.await_work(process, 1.0)
        self.stop(process)
        self.assertTrue(checkpoint.exists())
        done = program(*words)
        self.expect(done, SUCCESS)
        self.assertIn("going on at image", done.stdout)

    def test_commands_that_keep_nothing(self):
        images = sorted((self.long / "rgb").iterdir())
        target = self.folder / "merged.dxmap"
        for words in (["features", *images, "--npz", self.folder / "npz"],
                      ["bench", "features", self.long, "--features", "orb", "--frames", "300"],
                      ["vocab", "train", self.long, "--features", "orb", "--out", self.folder / "v"],
                      ["map", "merge", *[self.root / "m.dxmap"] * 60, "--out", target]):
            process = self.start(*words)
            self.await_work(process, 0.3)
            self.stop(process)
        self.assertFalse(target.exists())
        for archive in (self.folder / "npz").iterdir():
            self.assertEqual(archive.suffix, ".npz")


if __name__ == "__main__":
    run_tests()
