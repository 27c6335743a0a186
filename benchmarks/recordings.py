# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The dxslam authors
"""Where the benchmarks find the real recordings."""
import os
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def shared_folder():
    """$DXSLAM_SHARED or ../shared; ends the program if no recordings are there."""
    folder = Path(os.environ.get("DXSLAM_SHARED", ROOT.parent / "shared"))
    if not (folder / "data").is_dir():
        sys.exit(f"{Path(sys.argv[0]).name}: no recordings in {folder}/data, "
                 "expected them there or in $DXSLAM_SHARED")
    return folder
