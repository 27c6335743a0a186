#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The dxslam authors
"""What the pages name is there: files, pages, sections, commands and their options.

usage: docs_test.py [CLASS[.test]]   with $DXSLAM_PROGRAM or build/release/dxslam
"""
import os
import pathlib
import re
import shutil
import subprocess
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent
PROGRAM = os.environ.get("DXSLAM_PROGRAM", str(ROOT / "build" / "release" / "dxslam"))
TIMEOUT = 120  # seconds
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").glob("*.md"))]
HISTORY = {"experiments.md"}  # names files and options of their time
TOP = ("docs", "src", "tests", "benchmarks", "scripts", "examples", "models", "manifests", "package",
       "python", "ros", "training")


def slug(heading):
    """An anchor as GitHub makes it."""
    return re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")


class Names(unittest.TestCase):
    @staticmethod
    def each_page():
        return ((page, page.read_text()) for page in PAGES if page.name not in HISTORY)

    def test_files(self):
        for page, text in self.each_page():
            named = re.findall(r"`([\w./-]+/[\w./-]*)`", text)
            missing = [name for name in named if name.split("/")[0] in TOP
                       and not (ROOT / name).exists() and not list(ROOT.glob(name + ".*"))]
            self.assertEqual(missing, [], page.name)

    def test_links(self):
        for page, text in self.each_page():
            anchors = {slug(heading) for heading in re.findall(r"^#+ (.+)$", text, re.M)}
            for target in re.findall(r"\]\(([^)\s]+)\)", text):
                file, _, anchor = target.partition("#")
                if file.startswith("http"):
                    continue
                self.assertTrue((page.parent / file).exists(), f"{page.name}: {target}")
                if not file:
                    self.assertIn(anchor, anchors, page.name)

    def test_every_page_is_named_by_the_first(self):
        first = (ROOT / "README.md").read_text()
        named = set(re.findall(r"docs/(\w+\.md)", first))
        for page in list(named):  # or by one that the first names
            named |= set(re.findall(r"docs/(\w+\.md)", (ROOT / "docs" / page).read_text()))
        self.assertEqual({page.name for page in (ROOT / "docs").glob("*.md")} - named, set())


class Commands(unittest.TestCase):
    """Every `dxslam …` in a block of shell lines: the command is there, and has the options."""

    def helps(self, words):
        done = subprocess.run([PROGRAM, *words, "--help"], capture_output=True, text=True,
                              timeout=TIMEOUT)
        return done.stdout if done.returncode == 0 else None

    def test_commands_and_options(self):
        known = {}
        for page in PAGES:
            if page.name in HISTORY:
                continue
            blocks = re.findall(r"```sh\n(.*?)```", page.read_text(), re.S)
            lines = "\n".join(blocks).replace("\\\n", " ").splitlines()
            for line in lines:
                found = re.match(r"(?:build/release/)?dxslam ([a-z][^#|]*)", line)
                if not found or "|" in line.split("#")[0].split("[")[0]:
                    continue
                words = found[1].split()
                name = tuple(words[:2] if words[0] in ("map", "eval", "vocab", "config", "bench")
                             else words[:1])
                if name not in known:
                    known[name] = self.helps(name)
                self.assertIsNotNone(known[name], f"{page.name}: {line}")
                for option in re.findall(r"(?<=[ \[])--[a-z][a-z-]+", found[1]):
                    self.assertIn(option, known[name], f"{page.name}: {line}")
        self.assertGreater(len(known), 8)


class Reference(unittest.TestCase):
    @unittest.skipUnless(shutil.which("doxygen"), "no doxygen (scripts/setup --dev)")
    def test_is_made_without_a_warning(self):
        done = subprocess.run([ROOT / "scripts" / "make_docs"], capture_output=True, text=True,
                              timeout=TIMEOUT)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)
