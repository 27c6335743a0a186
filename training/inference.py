# SPDX-License-Identifier: Apache-2.0
"""Models run by OpenVINO on the CPU."""

from __future__ import annotations

from pathlib import Path

import openvino as ov


def compile_on_cpu(model: ov.Model | Path, precision: str = "f32", threads: int = 0) -> ov.CompiledModel:
    """The precision is said each time: left to itself, OpenVINO computes in bfloat16 where the processor can. 0 threads: all."""
    options: dict[str, object] = {"INFERENCE_PRECISION_HINT": precision}
    if threads > 0:
        options["INFERENCE_NUM_THREADS"] = threads
    return ov.Core().compile_model(str(model) if isinstance(model, Path) else model, "CPU", options)
