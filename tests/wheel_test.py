#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The dxslam authors
"""Builds the wheel where that is to be done, looks into it, and uses it in an environment that has
nothing but the wheel and what it depends on. Needs no network (scripts/setup --with-eval).

usage: wheel_test.py [CLASS[.test]]   with $DXSLAM_PROGRAM or build/release/dxslam
"""
import base64
import csv
import fcntl
import hashlib
import os
import re
import subprocess
import sys
import tempfile
import unittest
import zipfile
from pathlib import Path

from cli_test import PROGRAM, ROOT

FOLDER = ROOT / "build" / "wheel"
LIMIT = 40 * 2**20
FRAMES = 40
MAPS = "print(open('/proc/self/maps').read())"
RUN = """
import sys
import dxslam
recording, trajectory, features = sys.argv[1:]
source = dxslam.open_source(recording)
options = dxslam.Options(features=features, deterministic=True)
with dxslam.System(source.camera, options) as slam:
    for image in source:
        slam.process(image)
slam.trajectory().write(trajectory)
"""
# Compiled in from headers, or linked, without being part of the wheel's licences: what every C++ program
# has from compiler and system, and CPython itself.
SYSTEM = {"gcc-12", "glibc", "linux", "zlib", "python3.11"}
# Nothing that points to the sources.
ENVIRONMENT = {name: value for name, value in os.environ.items()
               if not name.startswith(("DXSLAM", "PYTHON")) and name != "LD_LIBRARY_PATH"}


def must(*command, **options):
    done = subprocess.run([*map(str, command)], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          text=True, stdin=subprocess.DEVNULL, **options)
    if done.returncode:
        raise RuntimeError(f"{command[0]}: exit {done.returncode}:\n{done.stdout}")
    return done.stdout


def make_wheel():
    """The wheel, built where something has changed; one test at a time."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    with open(FOLDER / ".lock", "w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        must(ROOT / "scripts" / "build_wheel")
        wheels = list((FOLDER / "dist").glob("*.whl"))
        if len(wheels) != 1:
            raise RuntimeError(f"{FOLDER / 'dist'} has {len(wheels)} wheels, expected one")
        return wheels[0]


def make_environment(wheel):
    """The Python of an environment with nothing but the wheel and what it depends on."""
    folder, key = FOLDER / "environment", hashlib.sha256(wheel.read_bytes()).hexdigest()
    stamp, python = folder / ".stamp", folder / "bin" / "python"
    with open(FOLDER / ".lock", "w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not stamp.exists() or stamp.read_text() != key:
            must(ROOT / ".venvs" / "python" / "bin" / "python", "-m", "venv", "--clear", folder)
            must(python, "-m", "pip", "install", "--no-index", "--find-links", ROOT / ".cache" / "wheels",
                 "--disable-pip-version-check", wheel, env=ENVIRONMENT)
            stamp.write_text(key)
    return python


def source_packages(files):
    """The Debian source packages of files."""
    owners = must("dpkg-query", "-S", *files)
    names = {name.strip() for line in owners.splitlines() for name in line.split(": ")[0].split(",")}
    return set(must("dpkg-query", "-W", "-f", "${source:Package}\n", *names).split())


class Contents(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.wheel = make_wheel()
        folder = tempfile.TemporaryDirectory(prefix="dxslam_wheel_")
        cls.addClassCleanup(folder.cleanup)
        cls.folder = Path(folder.name)
        with zipfile.ZipFile(cls.wheel) as archive:
            cls.names = archive.namelist()
            archive.extractall(cls.folder)
        cls.information = next(cls.folder.glob("dxslam-*.dist-info"))

    def test_has_the_right_name_and_size(self):
        version = re.search(r"project\(dxslam VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text())
        self.assertEqual(self.wheel.name,
                         f"dxslam-{version.group(1)}-cp311-cp311-manylinux_2_36_x86_64.whl")
        self.assertLessEqual(self.wheel.stat().st_size, LIMIT)
        tags = (self.information / "WHEEL").read_text()
        self.assertIn("Tag: cp311-cp311-manylinux_2_36_x86_64\n", tags)
        self.assertIn("Root-Is-Purelib: false\n", tags)

    def test_has_what_it_needs_and_nothing_else(self):
        self.assertEqual({name.split("/")[0] for name in self.names},
                         {"dxslam", "dxslam.libs", self.information.name})
        for folder in ("models", "manifests"):
            files = [path for path in (ROOT / folder).rglob("*") if path.is_file()]
            for path in files:
                self.assertIn(f"dxslam/data/{path.relative_to(ROOT)}", self.names)
        self.assertIn("dxslam/py.typed", self.names)
        self.assertIn("dxslam/_dxslam.pyi", self.names)
        unwanted = [name for name in self.names
                    if re.search(r"__pycache__|_test|\.(cpp|h|a|map)$", name)]
        self.assertFalse(unwanted)

    def test_record_lists_every_file_with_its_hash(self):
        with open(self.information / "RECORD", newline="") as file:
            rows = {row[0]: row[1:] for row in csv.reader(file)}
        self.assertEqual(set(rows), {name for name in self.names if not name.endswith("/")})
        for name, (code, size) in rows.items():
            if name != f"{self.information.name}/RECORD":
                data = (self.folder / name).read_bytes()
                digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).decode().rstrip("=")
                self.assertEqual((code, size), (f"sha256={digest}", str(len(data))), name)

    def test_names_no_folder_of_the_build(self):
        files = [self.folder / name for name in self.names if not name.endswith("/")]
        self.assertFalse([path.name for path in files if bytes(ROOT) in path.read_bytes()])

    def test_shows_nothing_but_the_module(self):
        extension = next((self.folder / "dxslam").glob("_dxslam*.so"))
        shown = must("nm", "-D", "--defined-only", extension).split("\n")
        self.assertEqual([line.split()[2] for line in shown if line], ["PyInit__dxslam"])

    def test_nothing_is_under_the_gpl(self):
        said = must(ROOT / "scripts" / "licence_scan", self.wheel)
        self.assertIn("libpng16-16 ", said)
        for unwanted in ("gfortran", "lapack", "libX11", "gdal", "libopencv_", "imgcodecs"):
            self.assertNotIn(unwanted, said)

    def test_has_the_licence_of_all_that_is_compiled_in(self):
        texts = self.information / "licenses"
        listed = source_packages([path.parent.relative_to(texts).name for path in texts.glob("*/copyright")])
        commands = must("ninja", "-C", FOLDER, "-t", "commands", "dxslam_python").splitlines()
        archives = set(re.findall(r"/usr/lib/\S+\.a\b", commands[-1]))
        headers = set(re.findall(r"^ +(/usr/include/\S+)", must("ninja", "-C", FOLDER, "-t", "deps"), re.M))
        self.assertTrue(archives and headers)
        self.assertFalse(source_packages(archives | headers) - listed - SYSTEM)
        self.assertTrue((texts / "LICENSE").exists())
        self.assertTrue((texts / "nanobind" / "LICENSE").exists())


class Installed(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.python = make_environment(make_wheel())
        folder = tempfile.TemporaryDirectory(prefix="dxslam_wheel_")
        cls.addClassCleanup(folder.cleanup)
        cls.folder = Path(folder.name)

    def run_python(self, *arguments, **environment):
        """In a folder that is not that of the sources."""
        return must(self.python, "-I", *arguments, cwd=self.folder, env=ENVIRONMENT | environment)


class Package(Installed):
    """The tests of the Python package, and with them the examples (python/tests)."""

    def test_all(self):
        recording = self.folder / "recording"
        must(PROGRAM, "synth", recording, "--frames", FRAMES, "--seed", 7)
        self.run_python("-m", "unittest", "discover", "-s", ROOT / "python" / "tests", "-p", "*_test.py",
                        DXSLAM_TEST_RECORDING=str(recording))


class Neighbours(Installed):
    """Other packages in the same process, whichever comes first."""
    USE = """
import numpy
features = dxslam.Extractor("hfnet").extract(numpy.random.default_rng(1).integers(0, 255, (480, 640), "uint8"))
assert len(features.keypoints) > 100
"""

    def test_openvino(self):
        other = "openvino.Core().available_devices"
        for first, second in (("dxslam", "openvino"), ("openvino", "dxslam")):
            said = self.run_python("-c", f"import {first}, {second}\n{other}\n{self.USE}\n{other}\n{MAPS}")
            self.assertEqual(len(set(re.findall(r"\S*/libopenvino\.so\S*", said))), 1, said)

    def import_unpacked(self, python):
        """Imports dxslam from a folder that has nothing else."""
        with zipfile.ZipFile(make_wheel()) as archive:
            archive.extractall(self.folder / "unpacked")
        return subprocess.run(
            [python, "-I", "-c", "import sys; sys.path.insert(0, 'unpacked'); import dxslam; " + MAPS],
            cwd=self.folder, env=ENVIRONMENT, capture_output=True, text=True)

    def test_openvino_in_another_folder(self):
        done = self.import_unpacked(self.python)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("unpacked/dxslam/_dxslam", done.stdout)
        self.assertIn("site-packages/openvino/libs/libopenvino.so", done.stdout)

    def test_no_openvino(self):
        done = self.import_unpacked(ROOT / ".venvs" / "python" / "bin" / "python")
        self.assertEqual(done.returncode, 1, done.stdout)
        self.assertRegex(done.stderr, r"ImportError: libopenvino\.so\S* is not found, expected that of the "
                                      r"package openvino==[\d.]+: run pip install")


class Results(Installed):
    """With OpenCV of the wheel and of the program: the same poses to the bit."""

    def test_same_as_the_program(self):
        recording, expected, found = (self.folder / name for name in ("recording", "expected", "found"))
        must(PROGRAM, "synth", recording, "--frames", FRAMES, "--seed", 7, "--factor", "image_noise",
             "--factor", "depth_noise")
        for features in ("hfnet", "orb"):
            must(PROGRAM, "run", recording, "--out", expected, "--features", features, "--deterministic")
            self.run_python("-c", RUN, recording, found, features)
            self.assertEqual(found.read_text(), (expected / "trajectory.txt").read_text(), features)


if __name__ == "__main__":
    sys.exit(unittest.main())
