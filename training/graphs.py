# SPDX-License-Identifier: Apache-2.0
"""Rounds the input of the first convolution, which NNCF leaves in floating point: its own quantiser would have to stand
before the normalisation, where darkness would be rounded away."""

from __future__ import annotations

import numpy as np
import openvino as ov
from openvino import opset13 as ops

INPUT_RANGE = 6.0  # deviations of the normalised image; what is brighter saturates
LEVELS = 256


def quantise_first_layer(model: ov.Model) -> None:
    """In place: the normalised image becomes signed 8-bit, so that the first convolution runs in integers."""
    shuffle = next(n for n in model.get_ordered_ops() if n.get_type_name() == "SpaceToDepth")
    top = np.full((1, 1, 1, 1), INPUT_RANGE, np.float32)
    bottom = -top * np.float32(128 / 127)
    bounds = [ops.constant(b) for b in (bottom, top, bottom, top)]
    (port,) = shuffle.output(0).get_target_inputs()
    port.replace_source_output(ops.fake_quantize(shuffle.output(0), *bounds, LEVELS).output(0))
    model.validate_nodes_and_infer_types()
