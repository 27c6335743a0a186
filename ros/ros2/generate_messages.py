#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The dxslam authors
"""Generates C, C++ and Python code of a ROS 2 message package with the generators of the wheels.

usage: generate_messages.py PACKAGE_FOLDER OUTPUT_FOLDER
       generate_messages.py --list PACKAGE_FOLDER OUTPUT_FOLDER

PACKAGE_FOLDER has the name of the package and holds msg/*.msg and srv/*.srv; they may use the
messages of the environment that runs this program. Makes OUTPUT_FOLDER/include/PACKAGE (C and C++,
sources too) and OUTPUT_FOLDER/python/PACKAGE. --list prints the sources to be compiled, one per
line as KIND:PATH (KIND: c, cpp, or the name of the Python extension module), without making anything.

It stands in for the CMake functions of ROS, which do not work from wheels.
"""
import os
import sys
from pathlib import Path

C_SUPPORTS = ["rosidl_typesupport_fastrtps_c", "rosidl_typesupport_introspection_c"]
CPP_SUPPORTS = ["rosidl_typesupport_fastrtps_cpp", "rosidl_typesupport_introspection_cpp"]
# Generators whose files have the names of others' files: each has a folder of its own.
APART = {"rosidl_typesupport_c": "{}__type_support.cpp",
         "rosidl_typesupport_cpp": "{}__type_support.cpp",
         "rosidl_typesupport_introspection_c": "detail/{}__type_support.c",
         "rosidl_typesupport_introspection_cpp": "detail/{}__type_support.cpp"}


def interfaces(package):
    """Paths below the package: msg/State.msg, srv/SaveMap.srv."""
    return sorted(path.relative_to(package) for kind in ("msg", "srv")
                  for path in (package / kind).glob(f"*.{kind}"))


def snake(name):
    from rosidl_pycommon import convert_camel_case_to_lower_case_underscore
    return convert_camel_case_to_lower_case_underscore(name)


def sources(package, output):
    """(kind, path) of everything to be compiled."""
    include, python = output / "include" / package.name, output / "python" / package.name
    module = f"{package.name}_s__rosidl_typesupport_c"
    for interface in interfaces(package):
        detail, name = include / interface.parent / "detail", snake(interface.stem)
        for part in ("functions", "description", "type_support"):
            yield "c", detail / f"{name}__{part}.c"
        yield "cpp", detail / f"{name}__type_support_c.cpp"
        yield "cpp", detail / "dds_fastrtps" / f"{name}__type_support.cpp"
        for generator, file in APART.items():
            yield (file.rsplit(".")[-1],
                   output / generator / package.name / interface.parent / file.format(name))
        yield module, python / interface.parent / f"_{name}_s.c"
    yield module, python / f"_{package.name}_s.ep.rosidl_typesupport_c.c"


class Generators:
    """The generators of one package; each takes a file of arguments."""

    def __init__(self, package, output):
        self.package, self.name = package, package.name
        self.share = Path(sys.prefix) / "share"
        self.include = output / "include" / self.name
        self.python = output / "python" / self.name
        self.idl = output / "idl" / self.name
        self.apart = {generator: output / generator / self.name for generator in APART}
        for folder in (self.include, self.python, self.idl, *self.apart.values()):
            for kind in {interface.parent for interface in interfaces(package)}:
                (folder / kind).mkdir(parents=True, exist_ok=True)

    def translate(self):
        from rosidl_adapter.msg import convert_msg_to_idl
        from rosidl_adapter.srv import convert_srv_to_idl
        for interface in interfaces(self.package):
            convert = convert_msg_to_idl if interface.suffix == ".msg" else convert_srv_to_idl
            convert(self.package, self.name, interface, self.idl / interface.parent)
        return [interface.with_suffix(".idl") for interface in interfaces(self.package)]

    def run(self, generator, generate, output, idl_files, **more):
        """Calls generate(path of the arguments)."""
        from rosidl_cli.command.helpers import generator_arguments_file, legacy_generator_arguments
        arguments = legacy_generator_arguments(
            package_name=self.name, interface_files=[f"{self.idl}:{idl}" for idl in idl_files],
            include_paths=[self.share], templates_path=self.share / generator / "resource",
            output_path=output)
        with generator_arguments_file(**arguments, **more) as path:
            return generate(path)

    def write_visibility_control(self, generator, suffix, output):
        from rosidl_cli.command.helpers import generate_visibility_control_file
        name = f"{generator}__visibility_control{suffix}"
        generate_visibility_control_file(
            package_name=self.name, template_path=self.share / generator / "resource" / f"{name}.in",
            output_path=output / "msg" / name)

    def generate(self):
        import rosidl_generator_c
        import rosidl_generator_cpp
        import rosidl_generator_py
        import rosidl_generator_type_description as type_description
        import rosidl_typesupport_c
        import rosidl_typesupport_cpp
        import rosidl_typesupport_fastrtps_c
        import rosidl_typesupport_fastrtps_cpp
        import rosidl_typesupport_introspection_c
        import rosidl_typesupport_introspection_cpp

        idl_files = self.translate()
        packages = [f"{path.name}:{path}" for path in self.share.iterdir()
                    if any((path / kind).is_dir() for kind in ("msg", "srv"))]
        self.run("rosidl_generator_type_description", type_description.generate_type_hash,
                 self.include, idl_files, include_paths=packages)
        described = [f"{idl}:{self.include / idl.with_suffix('.json')}" for idl in idl_files]
        for generator in ("rosidl_generator_c", C_SUPPORTS[0], CPP_SUPPORTS[0]):
            self.write_visibility_control(generator, ".h", self.include)
        self.write_visibility_control("rosidl_generator_cpp", ".hpp", self.include)
        self.write_visibility_control(C_SUPPORTS[1], ".h", self.apart[C_SUPPORTS[1]])
        self.run("rosidl_generator_c", lambda path: rosidl_generator_c.generate_c(path),
                 self.include, idl_files, type_description_tuples=described,
                 ros_interface_files=[str(self.package / path) for path in interfaces(self.package)])
        self.run("rosidl_generator_cpp", rosidl_generator_cpp.generate_cpp, self.include, idl_files,
                 type_description_tuples=described)
        self.run(C_SUPPORTS[0], rosidl_typesupport_fastrtps_c.generate_typesupport_fastrtps_c,
                 self.include, idl_files)
        self.run(CPP_SUPPORTS[0], rosidl_typesupport_fastrtps_cpp.generate_cpp, self.include,
                 idl_files)
        for generator, generate in {
                C_SUPPORTS[1]: rosidl_typesupport_introspection_c.generate_c,
                CPP_SUPPORTS[1]: rosidl_typesupport_introspection_cpp.generate_cpp,
                "rosidl_typesupport_c":
                    lambda path: rosidl_typesupport_c.generate_c(path, C_SUPPORTS),
                "rosidl_typesupport_cpp":
                    lambda path: rosidl_typesupport_cpp.generate_cpp(path, CPP_SUPPORTS)}.items():
            self.run(generator, generate, self.apart[generator], idl_files)
        self.run("rosidl_generator_py",
                 lambda path: rosidl_generator_py.generate_py(path, ["rosidl_typesupport_c"]),
                 self.python, idl_files)
        (self.python / "__init__.py").touch()


def main(arguments):
    list_only = arguments[:1] == ["--list"]
    if len(arguments) != 2 + list_only:
        sys.exit(__doc__)
    package, output = (Path(os.path.abspath(path)) for path in arguments[list_only:])
    if list_only:
        print("\n".join(f"{kind}:{path}" for kind, path in sources(package, output)))
        return
    Generators(package, output).generate()
    missing = [str(path) for _, path in sources(package, output) if not path.exists()]
    if missing:
        sys.exit(f"generate_messages: the generators did not make {', '.join(missing)}")


if __name__ == "__main__":
    main(sys.argv[1:])
