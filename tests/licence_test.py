#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The dxslam authors
"""Nothing that the program links or loads is under the GPL, and the scan that says so works.

usage: licence_test.py [CLASS[.test]]   with $DXSLAM_PROGRAM or build/release/dxslam
"""
import importlib.machinery
import importlib.util
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
import zipfile
from pathlib import Path

sys.dont_write_bytecode = True
ROOT = Path(__file__).resolve().parent.parent
PROGRAM = os.environ.get("DXSLAM_PROGRAM", str(ROOT / "build" / "release" / "dxslam"))


def load_scan():
    loader = importlib.machinery.SourceFileLoader("scan", str(ROOT / "scripts" / "licence_scan"))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("scan", loader))
    loader.exec_module(module)
    return module


scan = load_scan()


def copyright_file(*paragraphs):
    return "\n\n".join(["Format: https://www.debian.org/", *paragraphs])


class Program(unittest.TestCase):
    def test_nothing_is_under_the_gpl(self):
        done = subprocess.run([ROOT / "scripts" / "licence_scan", PROGRAM], text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        self.assertEqual(done.returncode, 0, done.stdout)
        self.assertIn("libpng16", done.stdout)
        self.assertIn("openvino (wheel)", done.stdout)
        for unwanted in ("gdal", "poppler", "jbig", "imgcodecs"):
            self.assertNotIn(unwanted, done.stdout)

    def test_knows_what_was_copied_out_of_a_wheel(self):
        for library in (ROOT / ".venv" / "lib").glob("python3*/site-packages/openvino/libs/libtbb.so.*"):
            with tempfile.TemporaryDirectory() as folder:
                copy = Path(folder) / library.name
                shutil.copy(library, copy)
                self.assertEqual(scan.wheel_of(copy), scan.wheel_of(library))
                copy.write_bytes(copy.read_bytes() + b"changed")
                self.assertIsNone(scan.wheel_of(copy))

    def test_a_program_that_is_not_there(self):
        done = subprocess.run([ROOT / "scripts" / "licence_scan", ROOT / "nothing"], text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        self.assertEqual(done.returncode, 2, done.stdout)


class Wheel(unittest.TestCase):
    PNG = scan.LIBRARIES / "libpng16.so.16"
    LICENCE = "p.dist-info/licenses/libpng16-16/copyright"

    def problems(self, files):
        """What the scan says on stderr of a wheel with such files: {name: file or text}."""
        with tempfile.TemporaryDirectory() as folder:
            wheel = Path(folder) / "p-1-py3-none-any.whl"
            with zipfile.ZipFile(wheel, "w") as archive:
                for name, content in files.items():
                    is_file = isinstance(content, Path)
                    archive.writestr(name, content.read_bytes() if is_file else content)
            done = subprocess.run([ROOT / "scripts" / "licence_scan", wheel], text=True,
                                  stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        self.assertEqual(done.returncode, 1 if done.stderr else 0, done.stderr)
        return done.stderr

    def test_libraries_need_a_licence_text(self):
        copy = f"p.libs/libpng16-0123abcd{self.PNG.resolve().name.removeprefix('libpng16')}"
        self.assertIn("libpng16-16, whose licence", self.problems({copy: self.PNG}))
        text = copyright_file("Files: *\nLicense: libpng")
        self.assertEqual(self.problems({copy: self.PNG, self.LICENCE: text}), "")
        text = copyright_file("Files: *\nLicense: GPL-2")
        self.assertIn("libpng16-16: GPL-2", self.problems({copy: self.PNG, self.LICENCE: text}))

    def test_nothing_may_be_missing(self):
        self.assertIn("libpng16.so.16 is needed", self.problems({"p/p.so": scan.LIBRARIES / "libfreetype.so.6"}))
        self.assertEqual(self.problems({"p/p.so": self.PNG}), "")

    def test_strangers_are_refused(self):
        self.assertIn("of None", self.problems({"p.libs/libmine-0123abcd.so.1": self.PNG}))


class Judgement(unittest.TestCase):
    def test_knows_the_gpl(self):
        for licence in ("GPL-2+", "GPL-3", "GPL-2.0-or-later", "AGPL-3", "GPL-2 or GPL-3",
                        "GNU General Public License"):
            self.assertTrue(scan.is_gpl(licence), licence)
        for licence in ("LGPL-2.1+", "GPL-2+ or BSD-3-clause", "GPL-3 with GCC runtime exception",
                        "Apache-2.0", "GNU Lesser General Public License"):
            self.assertFalse(scan.is_gpl(licence), licence)

    def test_a_library_under_the_gpl_is_a_problem(self):
        _, problem = scan.judge(copyright_file("Files: *\nLicense: GPL-2+\n text"))
        self.assertIn("GPL-2+", problem)
        _, problem = scan.judge(copyright_file("Files: *\nLicense: MIT",
                                               "Files: debian/*\n src/core.c\nLicense: GPL-2+"))
        self.assertIn("src/core.c", problem)

    def test_packaging_and_documentation_are_none(self):
        licences, problem = scan.judge(copyright_file(
            "Files: *\nLicense: MIT", "Files: debian/*\n src/doc/guide.html\nLicense: GPL-2+"))
        self.assertIsNone(problem)
        self.assertEqual(licences, ["MIT"])

    def test_what_cannot_be_read_is_a_problem(self):
        self.assertIsNotNone(scan.judge("This package was made by somebody.")[1])

    def test_reviewed_rows_hold_no_gpl(self):
        rows = scan.reviewed()
        self.assertIn("libc6", rows)
        self.assertFalse([name for name, licence in rows.items() if scan.is_gpl(licence)])


if __name__ == "__main__":
    sys.exit(unittest.main())
