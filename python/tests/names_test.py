# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The dxslam authors
"""What the package says of itself: names, docstrings with shapes and units, stubs."""
import ast
import inspect
import re
import unittest
from pathlib import Path

import dxslam
from dxslam import _dxslam

FOLDER = Path(dxslam.__file__).parent
# What Python itself asks for says what it does by its name.
PROTOCOL = re.compile(r"__\w+__$")


def public_names():
    """(name, object) of all that is public: classes, functions, their members."""
    for name in dxslam.__all__:
        value = getattr(dxslam, name)
        yield name, value
        if inspect.isclass(value) and not issubclass(value, BaseException):
            for member, inner in vars(value).items():
                if not PROTOCOL.match(member) and not member.startswith("_"):
                    yield f"{name}.{member}", inner


class Names(unittest.TestCase):
    def test_all_have_a_docstring(self):
        silent = [name for name, value in public_names()
                  if not (getattr(value, "__doc__", None) or "").strip()]
        self.assertEqual(silent, [])
        self.assertGreater(len(list(public_names())), 150)

    def test_arrays_say_their_shape_and_type(self):
        arrays = 0
        for name, value in public_names():
            doc = getattr(value, "__doc__", None) or ""
            shown = getattr(getattr(value, "fget", None), "__doc__", None) or doc
            signature = getattr(getattr(value, "fget", None), "__nb_signature__", None)
            if signature is None or "ndarray" not in str(signature):
                continue
            arrays += 1
            self.assertRegex(shown, r"\([\w, ]+\)", name)
            self.assertRegex(shown, r"float|int", name)
        self.assertGreater(arrays, 20)

    def test_times_lengths_and_distances_say_their_unit(self):
        units = {"stamp": "econds", "stamps": "econds", "positions": "metres", "depths": "metres",
                 "world_from_camera": "metres", "extract_ms": "illiseconds", "max_depth": "etres",
                 "fx": "ixels", "errors": "metres", "readout_time": "econds"}
        for name, value in public_names():
            unit = units.get(name.rpartition(".")[2])
            if unit and "." in name:
                self.assertIn(unit, value.__doc__, name)

    def test_stubs_are_those_of_the_module(self):
        self.assertTrue((FOLDER / "py.typed").is_file())
        tree = ast.parse((FOLDER / "_dxslam.pyi").read_text(encoding="utf-8"))
        said = {getattr(node, "name", None) for node in tree.body}
        for node in tree.body:
            if isinstance(node, ast.AnnAssign):
                said.add(node.target.id)
            elif isinstance(node, ast.Assign):
                said |= {target.id for target in node.targets}
        there = {name for name in vars(_dxslam) if not name.startswith("_")}
        self.assertEqual(there - said, set())

    def test_nothing_public_is_forgotten(self):
        there = {name for name in vars(_dxslam) if not name.startswith("_")}
        inner = {"OptionsBase", "evaluate_ate", "evaluate_rpe", "set_data_directory"}
        self.assertEqual(there - set(dxslam.__all__), inner)

    def test_exceptions_are_pythons_kinds_too(self):
        self.assertTrue(issubclass(dxslam.InputError, (dxslam.Error, ValueError)))
        self.assertTrue(issubclass(dxslam.ContractError, dxslam.Error))
        self.assertTrue(issubclass(dxslam.ContractError, RuntimeError))
        with self.assertRaisesRegex(ValueError, "no such file"):
            dxslam.Map.load("/nothing/here")

    def test_models_are_those_of_the_package(self):
        self.assertEqual(Path(dxslam.data_directory()), FOLDER / "data")
        self.assertIn("hfnet", dxslam.available_extractors())


if __name__ == "__main__":
    unittest.main()
