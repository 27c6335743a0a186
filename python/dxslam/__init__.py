# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The dxslam authors
"""Robust and efficient visual SLAM with deep features."""
from ._dxslam import *  # noqa: F403
from ._dxslam import __version__  # noqa: F401
