#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The dxslam authors
"""Installs what was built, moves it elsewhere, and uses it as programs of others do: by
find_package, by pkg-config, and as C++17.

usage: package_test.py [CLASS[.test]]   with $DXSLAM_PROGRAM or build/release/dxslam
"""
import math
import os
import re
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

from cli_test import PROGRAM, ROOT, TIMEOUT, poses

BUILD = Path(PROGRAM).resolve().parent
EXAMPLES = ROOT / "examples" / "cpp"
FRAMES = 40
# Nothing that points to the sources.
ENVIRONMENT = {name: value for name, value in os.environ.items()
               if not name.startswith("DXSLAM") and name != "LD_LIBRARY_PATH"}


def call(*command, **environment):
    return subprocess.run([*map(str, command)], capture_output=True, text=True, timeout=TIMEOUT,
                          stdin=subprocess.DEVNULL, env=ENVIRONMENT | environment)


def must(*command, **environment):
    done = call(*command, **environment)
    if done.returncode:
        raise RuntimeError(f"{command[0]}: exit {done.returncode}:\n{done.stdout}{done.stderr}")
    return done.stdout


def build_examples(prefix, folder):
    must("cmake", "-G", "Ninja", "-S", EXAMPLES, "-B", folder, f"-DCMAKE_PREFIX_PATH={prefix}",
         "-DCMAKE_CXX_STANDARD=17", "-DCMAKE_CXX_FLAGS=-Wall -Wextra -Werror")
    must("cmake", "--build", folder)


class Package(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory(prefix="dxslam_package_")
        cls.addClassCleanup(folder.cleanup)
        cls.folder = Path(folder.name)
        must("cmake", "--install", BUILD, "--prefix", "/built/for/here", DESTDIR=str(cls.folder))
        cls.prefix = cls.folder / "moved" / "here"
        cls.prefix.parent.mkdir()
        (cls.folder / "built" / "for" / "here").rename(cls.prefix)
        cls.program = cls.prefix / "bin" / "dxslam"
        cls.library = next(cls.prefix.glob("lib*/**/libdxslam.so"))
        cls.recording = cls.folder / "recording"
        must(cls.program, "synth", cls.recording, "--frames", FRAMES, "--seed", 7)
        build_examples(cls.prefix, cls.folder / "examples")

    def test_examples_find_their_way(self):
        map_file, trajectory = self.folder / "map.dxmap", self.folder / "trajectory.txt"
        trajectory.write_text(must(self.folder / "examples" / "run_slam", self.recording, map_file))
        tracked = {row[0]: row[1:4] for row in poses(trajectory)}
        self.assertGreaterEqual(len(tracked), 0.9 * FRAMES)
        said = must(self.program, "eval", "ate", self.recording / "groundtruth.txt", trajectory)
        rmse = re.search(r"rmse\D+([\d.]+)", said, re.I)
        self.assertIsNotNone(rmse, said)
        self.assertLess(float(rmse.group(1)), 0.02, said)

        stamps = [line.split() for line in (self.recording / "rgb.txt").read_text().splitlines()
                  if not line.startswith("#")]
        stamp, name = stamps[FRAMES // 2]
        found = must(self.folder / "examples" / "find_image", map_file, self.recording / name,
                     (self.recording / name.replace("rgb/", "depth/")).with_suffix(".png"))
        position = [float(word) for word in found.split()[1:4]]
        self.assertLess(math.dist(position, tracked[float(stamp)]), 0.02)

    def test_pkg_config_is_enough(self):
        folder = self.library.parent / "pkgconfig"
        flags = must("pkg-config", "--cflags", "--libs", "dxslam", PKG_CONFIG_PATH=str(folder))
        self.assertNotIn("imgcodecs", flags)
        program = self.folder / "with_pkg_config"
        must("g++", "-std=c++17", EXAMPLES / "run_slam.cpp", "-o", program, *flags.split(),
             f"-Wl,-rpath,{self.library.parent}")
        self.assertEqual(call(program).returncode, 2)  # it tells its usage
        refused = call(program, self.folder / "nothing")
        self.assertEqual(refused.returncode, 3, refused.stderr)
        self.assertIn("nothing", refused.stderr)

    def test_every_header_is_cxx17(self):
        include = self.prefix / "include"
        source = self.folder / "headers.cpp"
        headers = sorted(path.relative_to(include) for path in include.rglob("*.h"))
        self.assertLess(len(headers), 80)
        source.write_text("".join(f"#include <{header}>\n" for header in headers))
        flags = must("pkg-config", "--cflags", "dxslam",
                     PKG_CONFIG_PATH=str(self.library.parent / "pkgconfig"))
        system = [flag.replace("-I/usr", "-isystem/usr") for flag in flags.split()]
        must("g++", "-std=c++17", "-Wall", "-Wextra", "-Wpedantic", "-Wshadow", "-Werror",
             "-fsyntax-only", source, *system)

    def test_models_are_those_of_the_moved_tree(self):
        manifest = self.prefix / "share" / "dxslam" / "models" / "hfnet" / "manifest.yaml"
        whole = manifest.with_suffix(".whole")
        shutil.copy(manifest, whole)
        self.addCleanup(whole.replace, manifest)
        manifest.write_text("broken: true\n")
        for command in ([self.folder / "examples" / "run_slam", self.recording],
                        [self.program, "run", self.recording, "--features", "hfnet"]):
            done = call(*command)
            self.assertEqual(done.returncode, 3, done.stdout + done.stderr)
            self.assertIn(str(manifest), done.stderr)

    def test_libraries_are_those_of_the_moved_tree(self):
        for file in (self.program, self.library, self.folder / "examples" / "run_slam"):
            used = must("ldd", file)
            self.assertNotIn("site-packages", used)
            self.assertNotIn("not found", used)
            self.assertRegex(used, rf"libopenvino\.so\S* => {re.escape(str(self.prefix))}/")

    def test_nothing_is_under_the_gpl(self):
        said = must(ROOT / "scripts" / "licence_scan", self.library, self.program)
        self.assertIn("openvino (wheel)", said)

    def test_shows_its_own_names_only(self):
        soname = re.search(r"SONAME.*\[(.*)\]", must("readelf", "-d", self.library)).group(1)
        version = must(self.program, "--version").split()[1]
        self.assertEqual(soname, "libdxslam.so." + ".".join(version.split(".")[:2]))
        shown = must("nm", "-D", "-C", "--defined-only", self.library).splitlines()
        names = [line.split(maxsplit=2)[2] for line in shown]
        self.assertTrue(any(name.startswith("dxslam::System::process") for name in names))
        others = [name for name in names if "dxslam::" not in name]
        self.assertFalse(others[:5])


if __name__ == "__main__":
    unittest.main()
