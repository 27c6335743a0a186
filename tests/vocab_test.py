#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The dxslam authors
"""Runs `dxslam vocab` as a user does: training, inspection, conversion, broken files.

usage: vocab_test.py [CLASS[.test]]   with $DXSLAM_PROGRAM or build/release/dxslam
"""
import re
import resource
import shutil
import signal
import subprocess
import sys
import time
import unittest

from cli_test import BAD_USAGE, INTERRUPTED, PROGRAM, ROOT, TIMEOUT, Recorded, dxslam

FRAMES = 24


class Vocab(Recorded):
    frames, seed = FRAMES, 3

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.vocabulary = cls.folder / "orb.fbow"
        cls.trained = cls.train(cls.vocabulary)

    @classmethod
    def train(cls, out, *options, source=None):
        words = () if "--words" in options else ("--words", 500)
        return dxslam("vocab", "train", source or cls.recording, "--features", "orb", "--out", out,
                      *words, *options)

    def info(self, path):
        done = dxslam("vocab", "info", path)
        self.assertEqual(done.returncode, 0, done.stderr)
        return dict(re.split(r"\s{2,}", line, maxsplit=1) for line in done.stdout.splitlines())

    def test_trains_as_the_paper(self):
        self.assertEqual(self.trained.returncode, 0, self.trained.stderr)
        info = self.info(self.vocabulary)
        self.assertEqual(info["name"], "orb incremental")
        self.assertEqual(info["words"], "500")
        self.assertEqual(info["descriptors"], "32 bytes")
        self.assertEqual(info["file"], "FBoW with checksum")

    def test_trains_by_kmeans(self):
        out = self.folder / "kmeans.fbow"
        done = self.train(out, "--method", "kmeans", "--branching", 8, "--words", 0, "--depth", 2)
        self.assertEqual(done.returncode, 0, done.stderr)
        info = self.info(out)
        self.assertEqual(info["depth"], "2")
        self.assertLessEqual(int(info["words"]), 64)

    def test_trains_on_a_part_and_on_photos(self):
        out = self.folder / "photos.fbow"
        photos = next(self.recording.glob("rgb"))
        for source, images in ((f"{self.recording}@4:20:4", 4), (f"{photos}@:3", 9)):
            done = self.train(out, source=source)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn(f"from {images} images", done.stdout)
        self.refuse(self.train(out, source=f"{self.recording}@24:"), "24 images")

    def test_converts_there_and_back_without_loss(self):
        text, back = self.folder / "orb.txt", self.folder / "back.fbow"
        for source, target in ((self.vocabulary, text), (text, back)):
            done = dxslam("vocab", "convert", source, target)
            self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(text.read_text().splitlines()[0], r"^10 \d+ 0 0$")
        self.assertEqual(self.info(text)["file"], "DBoW2 text")
        kept = ("words", "weights", "depth", "descriptors", "inner nodes")
        before, after = self.info(self.vocabulary), self.info(back)
        self.assertEqual([before[key] for key in kept], [after[key] for key in kept])

    def interrupt(self, command, state):
        """Stops a command once it has something to save, however quick the machine is."""
        early = 0  # stops before that
        for delay in (0.4, 0.8, 1.2, 1.6, 2.4, 3.2, 5, 10, 20):
            process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
            time.sleep(delay)
            process.send_signal(signal.SIGINT)
            process.communicate(timeout=TIMEOUT)
            if process.returncode == 0:
                break  # too late
            if process.returncode == INTERRUPTED:
                if state.exists():
                    return True
                early += 1
        self.assertEqual(early, 0, "it was stopped, and never left a state")
        return False

    def test_goes_on_after_an_interruption(self):
        whole, out, state = (self.folder / name for name in ("whole.fbow", "resumed.fbow", "state"))
        command = ["vocab", "train", *[self.recording] * 6, "--features", "orb", "--words", 500]
        resumable = [*command, "--out", out, "--checkpoint", state]
        if not self.interrupt([PROGRAM, *map(str, resumable)], state):
            self.skipTest("no training could be stopped between its start and its end")
        self.refuse(dxslam(*resumable, "--match-ratio", "0.8"), state)
        done = dxslam(*resumable)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("going on at image", done.stdout)
        self.assertFalse(state.exists())
        self.assertEqual(dxslam(*command, "--out", whole).returncode, 0)
        self.assertEqual(out.read_bytes(), whole.read_bytes())

    def test_refuses_what_is_no_vocabulary(self):
        broken = self.folder / "broken.fbow"
        content = self.vocabulary.read_bytes()
        broken.write_bytes(content[:-1000])
        self.refuse(dxslam("vocab", "info", broken), broken, "bytes")
        damaged = bytearray(content)
        damaged[len(content) // 2] ^= 1
        broken.write_bytes(damaged)
        self.refuse(dxslam("vocab", "info", broken), broken, "checksum")
        self.refuse(dxslam("vocab", "convert", ROOT / "LICENSE", broken), "expected a vocabulary")
        self.refuse(dxslam("vocab", "info", self.folder / "none"), "none")

    def test_a_vocabulary_is_not_converted_onto_itself(self):
        words = self.folder / "words.fbow"
        shutil.copy(self.vocabulary, words)
        before = words.read_bytes()
        self.refuse(dxslam("vocab", "convert", words, words, "--to", "dbow2"), words,
                    "an input of this command")
        self.assertEqual(words.read_bytes(), before)

    def test_words_of_other_features_are_refused(self):
        # As long as those of `orb`, but not the same.
        self.refuse(dxslam("run", self.recording, "--features", "orb+brief", "--vocabulary",
                           self.vocabulary), "trained on features `orb`", "`orb+brief`")

    def test_tries_its_files_before_the_work(self):
        other = self.folder / "other.txt"
        other.write_text("not a vocabulary\n")
        images = ("--words", 500, self.folder / "missing")  # never come to
        for words in (("train", *images, "--out", other), ("convert", self.folder / "missing", other)):
            self.refuse(dxslam("vocab", *words), "other.txt: is no vocabulary and is not replaced")
        self.assertEqual(other.read_text(), "not a vocabulary\n")
        nowhere = self.folder / "nowhere" / "file"
        for words in (("--out", nowhere), ("--out", self.folder / "v", "--checkpoint", nowhere)):
            self.refuse(dxslam("vocab", "train", self.recording, "--features", "orb", *words),
                        "nowhere/file: cannot be written")
        both = self.folder / "both"
        self.refuse(dxslam("vocab", "train", *images, "--out", both, "--checkpoint", self.folder / "." / "both"),
                    "both: is both --out and --checkpoint")
        again = self.folder / "again.fbow"
        again.write_bytes(self.vocabulary.read_bytes()[:100])
        self.assertEqual(dxslam("vocab", "convert", self.vocabulary, again).returncode, 0)

    def test_a_checkpoint_that_cannot_be_written_ends_nothing(self):
        # A limit on the size of files stands for a full disk: the vocabulary is smaller.
        out, limit = self.folder / "unkept.fbow", 200_000
        words = [PROGRAM, "vocab", "train", *[self.recording] * 9, "--features", "orb", "--words", 500,
                 "--out", out, "--checkpoint", self.folder / "unkept"]
        done = subprocess.run(
            [*map(str, words)], capture_output=True, text=True, timeout=TIMEOUT,
            preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit)))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stderr.count("File too large; the training goes on"), 1, done.stderr)
        self.assertLess(out.stat().st_size, limit)

    def test_refuses_nonsense(self):
        out = self.folder / "none.fbow"
        done = self.train(out, "--branching", 1)
        self.assertEqual(done.returncode, BAD_USAGE)
        self.assertIn("2 to 256", done.stderr)
        self.refuse(self.train(out, source=self.folder / "missing"), "missing")
        self.assertEqual(self.train(out, "--method", "magic").returncode, BAD_USAGE)
        self.assertFalse(out.exists())


class Shipped(unittest.TestCase):
    """The vocabularies that come with the program fit its extractors."""

    def test_are_whole(self):
        for name, descriptors in (("hfnet", "64 floats"), ("orb", "32 bytes")):
            path = ROOT / "models" / "vocabulary" / f"{name}.fbow"
            done = dxslam("vocab", "info", path)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn(f"{name} incremental", done.stdout)
            self.assertIn(descriptors, done.stdout)
            self.assertIn("FBoW with checksum", done.stdout)
            self.assertLess(path.stat().st_size, 6_000_000)


if __name__ == "__main__":
    signal.signal(signal.SIGINT, signal.SIG_DFL)  # where a shell has it ignored, programs would, too
    unittest.main(argv=[sys.argv[0], "-v", *sys.argv[1:]])
