# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The dxslam authors
"""How good a trajectory is: ATE and RPE as TUM defines them."""
from ._dxslam import AteReport, ErrorStatistics, RpeReport
from ._dxslam import evaluate_ate as ate
from ._dxslam import evaluate_rpe as rpe

__all__ = ["AteReport", "ErrorStatistics", "RpeReport", "ate", "rpe"]
