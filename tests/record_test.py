#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The dxslam authors
"""`dxslam record`: what it writes gives the same poses to the bit, others read it, and neither a
kill nor a full disk costs what was whole.

usage: record_test.py [CLASS[.test]]   with $DXSLAM_PROGRAM or build/release/dxslam
"""
import os
import resource
import signal
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PROGRAM = os.environ.get("DXSLAM_PROGRAM", str(ROOT / "build" / "release" / "dxslam"))
PYTHON = ROOT / ".venvs" / "eval" / "bin" / "python"
FRAMES = 24
TIMEOUT = 300

# Reads the file with checksums, decodes every message, and says what is in it.
READER = """
import sys
from mcap.reader import NonSeekingReader, make_reader
from rosbags.typesys import Stores, get_types_from_msg, get_typestore
store = get_typestore(Stores.EMPTY)
counts, shapes = {}, set()
with open(sys.argv[1], "rb") as file:
    reader = NonSeekingReader(file) if "cut" in sys.argv[1] else make_reader(file, validate_crcs=True)
    for schema, channel, message in reader.iter_messages():
        if schema.name not in store.fielddefs:
            types = get_types_from_msg(schema.data.decode(), schema.name)
            store.register({k: v for k, v in types.items() if k not in store.fielddefs})
        decoded = store.deserialize_cdr(message.data, schema.name)
        counts[channel.topic] = counts.get(channel.topic, 0) + 1
        if schema.name.endswith("Image"):
            assert len(decoded.data) == decoded.step * decoded.height
            shapes.add((channel.topic, decoded.encoding, decoded.width, decoded.height))
        if schema.name.endswith("CameraInfo"):
            assert decoded.k[0] > 0 and decoded.p[0] == decoded.k[0]
    if "cut" not in sys.argv[1]:
        statistics = reader.get_summary().statistics
        assert statistics.message_count == sum(counts.values()), statistics
for topic, count in sorted(counts.items()):
    print(topic, count)
for shape in sorted(shapes):
    print(*shape)
"""


def dxslam(*arguments, **options):
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True,
                          stdin=subprocess.DEVNULL, timeout=TIMEOUT, **options)


def limit_files(size):
    return lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))


class Record(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory(prefix="dxslam_record_")
        cls.addClassCleanup(folder.cleanup)
        cls.folder = Path(folder.name)
        cls.source = cls.folder / "source"
        done = dxslam("synth", cls.source, "--frames", FRAMES, "--width", 320, "--height", 240)
        if done.returncode:
            raise RuntimeError(done.stderr)

    def record(self, source, out, *options, code=0, **more):
        done = dxslam("record", source, "--out", out, *options, **more)
        self.assertEqual(done.returncode, code, done.stderr)
        return done

    def poses(self, recording):
        out = self.folder / ("out_" + recording.name)
        done = dxslam("run", recording, "--features", "orb", "--deterministic", "--out", out)
        self.assertEqual(done.returncode, 0, done.stderr)
        return (out / "trajectory.txt").read_text()

    def frames(self, recording):
        done = dxslam("info", recording)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return int(done.stdout.split("frames: ")[1].split()[0])

    def test_what_is_recorded_gives_the_same_poses(self):
        expected = self.poses(self.source)
        bag, folder, again = (self.folder / name for name in ("a.mcap", "a", "b.mcap"))
        self.record(self.source, bag)
        self.record(bag, folder, code=0)
        self.record(self.source, again, "--stride", 3, "--max-frames", 5)
        self.assertEqual(self.poses(bag), expected)
        self.assertEqual(self.frames(again), 5)
        # Depth of a bag is metres; in a folder it has 16 bits.
        self.assertEqual(self.frames(folder), FRAMES)
        tum = self.folder / "tum"
        self.record(self.source, tum)
        self.assertEqual(self.poses(tum), expected)

    @unittest.skipIf(subprocess.run([PYTHON, "-c", "import rosbags, mcap"], capture_output=True)
                     .returncode if PYTHON.exists() else True, "no rosbags and mcap")
    def test_others_read_it(self):
        bag = self.folder / "others.mcap"
        self.record(self.source, bag)
        cut = self.folder / "cut.mcap"
        for path, count in ((bag, FRAMES), (cut, None)):
            if path == cut:
                cut.write_bytes(bag.read_bytes()[:bag.stat().st_size // 2])
            done = subprocess.run([PYTHON, "-c", READER, path], capture_output=True, text=True,
                                  timeout=TIMEOUT)
            if count is None:  # which ends in an error of theirs, or not
                continue
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn(f"/camera/color/image_raw {count}\n", done.stdout)
            self.assertIn(f"/camera/aligned_depth_to_color/camera_info {count}\n", done.stdout)
            self.assertIn("/camera/color/image_raw bgr8 320 240\n", done.stdout)

    def test_a_kill_leaves_what_was_whole(self):
        for name in ("killed.mcap", "killed"):
            with self.subTest(name):
                out = self.folder / name
                sign = out if name.endswith("mcap") else out / "rgb.txt"
                process = subprocess.Popen([PROGRAM, "record", str(self.source), "--out", str(out)],
                                           stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
                enough = 3_000_000 if name.endswith("mcap") else 200
                while process.poll() is None and not (sign.exists() and sign.stat().st_size > enough):
                    time.sleep(0.001)
                process.kill()
                process.wait()
                self.assertGreater(self.frames(out), 2)

    def test_a_file_cut_anywhere_gives_what_is_whole(self):
        bag, cut = self.folder / "long.mcap", self.folder / "short.mcap"
        self.record(self.source, bag)
        data = bag.read_bytes()
        for share in (0.3, 0.5, 0.77, 0.999):
            cut.write_bytes(data[:int(len(data) * share)])
            self.assertGreaterEqual(self.frames(cut), int(FRAMES * share) - 2)

    def test_a_full_disk_is_said_and_leaves_what_was_whole(self):
        done = self.record(self.source, self.folder / "full.mcap", code=3,
                           preexec_fn=limit_files(2_000_000))
        self.assertIn("full.mcap: cannot be written: File too large", done.stderr)
        self.assertGreater(self.frames(self.folder / "full.mcap"), 2)
        self.assertLess(self.frames(self.folder / "full.mcap"), FRAMES)
        done = self.record(self.source, self.folder / "full", code=3, preexec_fn=limit_files(50_000))
        self.assertIn("cannot be written: File too large", done.stderr)
        self.assertEqual(list((self.folder / "full" / "rgb").iterdir()), [])

    def test_a_stop_finishes_the_file(self):
        out = self.folder / "stopped.mcap"
        process = subprocess.Popen([PROGRAM, "record", str(self.source), "--out", str(out)],
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        while process.poll() is None and not (out.exists() and out.stat().st_size > 1_000_000):
            time.sleep(0.001)
        process.send_signal(signal.SIGINT)
        output, errors = process.communicate(timeout=30)
        self.assertIn(process.returncode, (0, 5), errors)
        self.assertEqual(f"{self.frames(out)} images in {out}\n", output)
        self.assertEqual(out.read_bytes()[-8:], b"\x89MCAP0\r\n")

    def test_nothing_is_replaced(self):
        taken = self.folder / "taken.mcap"
        taken.write_bytes(b"precious")
        for out in (taken, self.source, self.folder):
            done = self.record(self.source, out, code=3)
            self.assertIn("is there already", done.stderr)
        self.assertEqual(taken.read_bytes(), b"precious")
        self.assertIn("expected a name that ends in .mcap",
                      self.record(self.source, self.folder / "x.bag", code=3).stderr)
        self.assertIn("no folder", self.record(self.source, self.folder / "no" / "x.mcap", code=3).stderr)


if __name__ == "__main__":
    unittest.main()
