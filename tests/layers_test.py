#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The dxslam authors
"""Checks the rules that keep the sources in layers, whole and small.

The layers and their order are the add_subdirectory lines of the top CMakeLists.txt; what a layer
may use is what its own CMakeLists.txt lists. Nothing is repeated here.
"""
import re
import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
SOURCE = ROOT / "src"
MAX_FILE_LINES = 500
MAX_FUNCTION_LINES = 80

# What only some files may include: (pattern of the header, files allowed, why). Tests may use the
# engines, too: as an oracle, or to make small models.
TEST = r".*_test\.cpp|.*/test_[a-z_]*\.h"
RESTRICTED = [
    (r"openvino/", rf"features/network/openvino_[a-z_]*\.(h|cpp)|{TEST}", "only openvino_* files know the network engine"),
    (r"unsupported/Eigen/", TEST, "only tests stand on what Eigen calls unsupported"),
    (r"(ceres|glog)/", r"(?!)", "our solvers are our own, and no log of a library is silenced"),
    (r"Eigen/(Cholmod|UmfPack|SPQR|KLU)Support", r"(?!)", "SuiteSparse is under the GPL"),
    (r"opencv2/imgcodecs", r"(?!)", "Debian's links the GPL (docs/dependencies.md)"),
    (r"png\.h", r"io/image_codecs/png_codec\.cpp", "one file knows libpng"),
    (r"(jpeglib|jerror|turbojpeg)\.h", r"io/image_codecs/jpeg_codec\.cpp", "one file knows libjpeg"),
    (r"(Imf|Imath|Iex)|OpenEXR/", r"io/image_codecs/exr_codec\.cpp", "one file knows OpenEXR"),
    (r"tiff", r"(?!)", "Debian's libtiff links the GPL (docs/dependencies.md)"),
    (r"io/image_codecs/", r"io/image_codecs/|io/primitives/image_file\.cpp", "io/primitives/image_file.h is their interface"),
    (r"sqlite3\.h", r"io/bags/sqlite_bag\.cpp", "one file knows SQLite"),
    (r"(zstd|lz4frame|bzlib)\.h", r"io/bags/(de)?compress\.cpp", "one file knows how chunks are packed"),
    (r"io/bags/", r"io/(bags|recordings)/", "recordings are opened by io/recordings"),
    (r"opencv2/highgui", r"(?!)", "nothing opens windows"),
    (r"(ros|rclcpp|cv_bridge|sensor_msgs)/", r"(?!)", "the library does not know ROS"),
]
# The core knows nothing of files, the console or clocks.
CORE_FORBIDDEN = {"iostream", "fstream", "filesystem", "chrono", "ctime", "cstdio"}


def layer_order():
    text = (ROOT / "CMakeLists.txt").read_text()
    return re.findall(r"^add_subdirectory\(src/(\w+)\)", text, re.M)


def declared(layer):
    """(uses of the library, further uses of its tests), as layer names, from its CMakeLists.txt."""
    text = re.sub(r"#.*", "", (SOURCE / layer / "CMakeLists.txt").read_text())
    calls = re.findall(r"(?:dxslam_layer|target_link_libraries)\s*\((.*?)\)", text, re.S)
    uses, test_uses = set(), set()
    for call in calls:
        library, _, tests = call.partition("TEST_DEPENDS")
        uses.update(re.findall(r"\bdxslam_(\w+)", library))
        test_uses.update(re.findall(r"\bdxslam_(\w+)", tests))
    layers = set(layer_order())
    return uses & layers - {layer}, test_uses & layers


def reachable(layers):
    """The layers and everything below that they bring along."""
    found, todo = set(), list(layers)
    while todo:
        layer = todo.pop()
        if layer not in found:
            found.add(layer)
            todo.extend(declared(layer)[0])
    return found


def source_files():
    return sorted(path for path in SOURCE.rglob("*") if path.suffix in (".h", ".cpp"))


def ros_files():
    return sorted(path for path in (ROOT / "ros").rglob("*") if path.suffix in (".h", ".cpp"))


def includes(path):
    """(line number, header) of every include."""
    for number, line in enumerate(path.read_text().splitlines(), 1):
        match = re.match(r'\s*#\s*include\s*[<"]([^>"]+)[>"]', line)
        if match:
            yield number, match.group(1)


def without_literals(text):
    """The code with comments, strings and characters blanked, line breaks kept."""
    def blank(match):
        return "\n" * match.group(0).count("\n")
    pattern = (r'R"(\w*)\(.*?\)\1"|//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"'
               r"|(?<![0-9a-fA-F])'(?:\\.|[^'\\\n])+'")
    return re.sub(pattern, blank, text, flags=re.S)


def function_lengths(text):
    """(first line, lines) of every outermost block that is not a namespace, class or the like."""
    code = without_literals(text)
    stack, head, line = [], "", 1
    for character in code:
        if character == "{":
            is_type = re.search(r"\b(namespace|class|struct|enum|union|extern)\b", head) and \
                not re.search(r"\)\s*(const|noexcept|override|final|->[^{]*)*\s*$", head)
            is_scope = is_type or head.rstrip().endswith("=")  # the latter is a table of values
            inside = any(kind == "function" for kind, _ in stack)
            stack.append(("scope" if is_scope or inside else "function", line))
            head = ""
        elif character == "}":
            if stack:
                kind, start = stack.pop()
                if kind == "function":
                    yield start, line - start + 1
            head = ""
        elif character == ";":
            head = ""
        else:
            head += character
        line += character == "\n"


def definitions(text):
    """(line, what it is) of every type and function that a text defines in a named namespace: `type
    a::B`, or `function a::b(parameters) const`."""
    code = re.sub(r"^[ \t]*#.*(?:\\\n.*)*", "", without_literals(text), flags=re.M)
    scopes, head, line = [], "", 1
    for character in code:
        line += character == "\n"
        if character == "{":
            words = re.sub(r"\) ?: ?\w+ ?[({].*", ")", " ".join(head.split()))  # no initialisers
            namespace = re.search(r"\bnamespace\b\s*([\w:]*)$", words)
            name = "" if scopes and not all(scopes) else namespace and namespace.group(1)
            if not namespace and scopes and all(scopes):
                head_of_type = re.match(
                    r"(?:template ?<.*> )?(?:struct|class|enum(?: class)?|union) (?:alignas\(.*\) )?"
                    r"([\w:]*\w)(?: final)?(?: ?:.*)?$", words)
                function = re.match(r"(?:.* |.*[&*>])?([\w:~]+|operator.+?) ?(\(.*\).*)$", words)
                if head_of_type:
                    yield line, f"type {'::'.join([*scopes, head_of_type.group(1)])}"
                elif function and "static" not in words.split() and not words.endswith("="):
                    yield line, "function " + "::".join([*scopes, "".join(function.groups())])
            scopes.append(name)
            head = ""
        elif character == "}":
            if scopes:
                scopes.pop()
            head = ""
        elif character == ";":
            head = ""
        else:
            head += character


class Layers(unittest.TestCase):
    def test_order_and_folders_agree(self):
        folders = {path.parent.name for path in SOURCE.glob("*/CMakeLists.txt")}
        self.assertEqual(set(layer_order()), folders)

    def test_layers_use_only_layers_below(self):
        order = layer_order()
        for layer in order:
            for use in declared(layer)[0]:
                self.assertLess(order.index(use), order.index(layer),
                                f"src/{layer}/CMakeLists.txt uses {use}, which is not below it")

    def test_includes_are_declared(self):
        layers, problems = set(layer_order()), []
        for path in source_files():
            own = path.relative_to(SOURCE).parts[0]
            uses, test_uses = declared(own)
            allowed = {own} | reachable(uses)
            if path.name.endswith("_test.cpp"):
                allowed |= reachable(test_uses)
            for number, header in includes(path):
                layer = header.split("/")[0]
                if "/" in header and layer in layers and layer not in allowed:
                    problems.append(f"{path.relative_to(ROOT)}:{number}: {own} does not list "
                                    f"{layer} in its CMakeLists.txt, but includes {header}")
        self.assertFalse(problems, "\n" + "\n".join(problems))

    def test_restricted_headers(self):
        problems = []
        for path in source_files():
            name = path.relative_to(SOURCE).as_posix()
            for number, header in includes(path):
                for pattern, allowed, why in RESTRICTED:
                    if re.match(pattern, header) and not re.match(allowed, name):
                        problems.append(f"src/{name}:{number}: includes {header}, but {why}")
                if name.startswith("core/") and not name.endswith("_test.cpp") \
                        and header in CORE_FORBIDDEN:
                    problems.append(f"src/{name}:{number}: the core must not include <{header}>")
        self.assertFalse(problems, "\n" + "\n".join(problems))

    def test_includes_name_their_layer(self):
        problems = [f"{path.relative_to(ROOT)}:{number}: {header}"
                    for path in source_files() for number, header in includes(path)
                    if re.match(r"\.\.?/", header) or
                    ("/" not in header and (path.parent / header).exists())]
        self.assertFalse(problems, "expected \"layer/header.h\":\n" + "\n".join(problems))


class Ros(unittest.TestCase):
    def test_the_transport_knows_nothing_of_slam(self):
        layers = set(layer_order())
        problems = [f"{path.relative_to(ROOT)}:{number}: {header}" for path in ros_files()
                    if path.is_relative_to(ROOT / "ros" / "ros2")
                    for number, header in includes(path)
                    if "/" in header and header.split("/")[0] in layers]
        self.assertFalse(problems, "\n" + "\n".join(problems))


class Sources(unittest.TestCase):
    def test_licence_header(self):
        files = [*source_files(), *ros_files(), *(ROOT / "tests").glob("*.py"),
                 *(ROOT / "ros").rglob("*.py")]
        missing = [str(path.relative_to(ROOT)) for path in files
                   if "SPDX-License-Identifier: Apache-2.0" not in path.read_text()[:200]]
        self.assertFalse(missing, f"no SPDX line in {missing}")

    def test_files_are_short(self):
        long = [f"{path.relative_to(ROOT)}: {lines} lines" for path in [*source_files(), *ros_files()]
                if (lines := len(path.read_text().splitlines())) > MAX_FILE_LINES]
        self.assertFalse(long, f"longer than {MAX_FILE_LINES} lines: {long}")

    def test_functions_are_short(self):
        long = [f"{path.relative_to(ROOT)}:{start}: {lines} lines" for path in [*source_files(), *ros_files()]
                for start, lines in function_lengths(path.read_text())
                if lines > MAX_FUNCTION_LINES]
        self.assertFalse(long, f"longer than {MAX_FUNCTION_LINES} lines: {long}")

    def test_nothing_is_defined_twice(self):
        """Two types of one name, or two inline functions, silently become one in a program that
        links both."""
        found = {}
        for path in [*source_files(), *ros_files()]:
            for line, what in definitions(path.read_text()):
                found.setdefault(what, []).append(f"{path.relative_to(ROOT)}:{line}")
        doubles = [f"{what}: {', '.join(places)}" for what, places in found.items()
                   if len(places) > 1]
        self.assertFalse(doubles, "\n" + "\n".join(doubles))

    def test_headers_are_guarded(self):
        missing = [str(path.relative_to(ROOT)) for path in [*source_files(), *ros_files()]
                   if path.suffix == ".h" and "#pragma once" not in path.read_text()]
        self.assertFalse(missing, f"no #pragma once in {missing}")


class Checker(unittest.TestCase):
    """The readers of the sources themselves."""

    def test_finds_definitions_of_named_namespaces(self):
        text = """
            namespace a {
            struct Declared;
            struct B : C { struct Inner {}; void f() {} };
            enum class D { kOne };
            inline int g(int x) { return x; }
            int g(double x) { if (x > 0.0) { return 1; } return 0; }
            B::B(int x) : x_(x) { g(x); }
            namespace { struct Hidden {}; int hidden() { return 0; } }
            }  // namespace a
            struct Outside {};"""
        self.assertEqual([what for _, what in definitions(text)],
                         ["type a::B", "type a::D", "function a::g(int x)",
                          "function a::g(double x)", "function a::B::B(int x)"])

    def test_counts_functions_not_scopes(self):
        body = "\n" * 90
        self.assertEqual([lines for _, lines in function_lengths(
            f"namespace a {{ struct B {{ void f() const {{{body}}} int g() {{ return 1; }} }};"
            f"{body}}}")], [91, 1])

    def test_ignores_braces_in_text(self):
        text = 'void f() { g("}"); h(\'{\'); /* } */ int x = 1\'000; // }\n\n}\n'
        self.assertEqual([lines for _, lines in function_lengths(text)], [3])


if __name__ == "__main__":
    sys.exit(unittest.main())
