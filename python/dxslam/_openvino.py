# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The dxslam authors
"""OpenVINO's library, where it is not beside us in the same site-packages."""
import ctypes
import importlib.metadata
import importlib.util
from pathlib import Path


def _wanted() -> str:
    try:
        requirements = importlib.metadata.requires("dxslam") or []
    except importlib.metadata.PackageNotFoundError:
        requirements = []
    return next((name for name in requirements if name.startswith("openvino")), "openvino")


def load_elsewhere(error: ImportError) -> None:
    """Loads OpenVINO from where Python finds it, e.g. the user's site-packages, for the extension to be
    imported again. Raises ImportError where that is of no use. `error`: of the first import."""
    if "libopenvino" not in str(error) and "libtbb" not in str(error):
        raise error
    spec = importlib.util.find_spec("openvino")
    folders = spec.submodule_search_locations if spec else None
    loaded = []
    for folder in folders or []:
        for pattern in ("libtbb.so.*", "libopenvino.so.*"):
            for library in (Path(folder) / "libs").glob(pattern):
                ctypes.CDLL(str(library))
                loaded.append(library.name)
    missing = str(error).split(":")[0]
    if missing not in loaded:
        raise ImportError(f"{missing} is not found, expected that of the package {_wanted()}: "
                          f"run pip install {_wanted()}", name="openvino") from error
