# SPDX-License-Identifier: Apache-2.0
"""ONNX graph to OpenVINO IR: FP16-stored weights, and INT8 by post-training quantisation.

python -m training.quantise MODEL.onnx --data DIR --out models/hfnet
Runs in the `deploy` environment (OpenVINO and NNCF, no torch).
"""

from __future__ import annotations

import argparse
import logging
from pathlib import Path

import cv2
import nncf
import numpy as np
import openvino as ov
from numpy.typing import NDArray

from .data import LAST_TRAINING_FRAME, photo_files
from .degrade import low_light, photometric
from .first_layer import quantise_first_layer

Tensor = NDArray[np.float32]
CALIBRATION_IMAGES = 320
DARK_SHARE = 0.35


def calibration_files(data: Path, count: int) -> list[Path]:
    """Training photos and training frames, half and half."""
    photos = photo_files(data)
    frames = [data / f"7scenes_redkitchen/frame-{n:06d}.color.jpg" for n in range(0, LAST_TRAINING_FRAME + 1, 2)]
    half = count // 2
    return [photos[i] for i in np.linspace(0, len(photos) - 1, half).astype(int)] + [
        frames[i] for i in np.linspace(0, len(frames) - 1, count - half).astype(int)
    ]


def calibration_images(data: Path, count: int = CALIBRATION_IMAGES) -> list[Tensor]:
    """Network inputs: as they are, dark and noisy, or otherwise degraded."""
    rng = np.random.default_rng(0)
    images = []
    for file in calibration_files(data, count):
        grey = cv2.resize(cv2.imread(str(file), cv2.IMREAD_GRAYSCALE), (640, 480)).astype(np.float32) / 255
        draw = rng.random()
        if draw < DARK_SHARE:
            grey = low_light(grey, rng)
        elif draw < DARK_SHARE + 0.25:
            grey = photometric(grey, rng)
        images.append(np.clip(np.floor(grey * 255), 0, 255).astype(np.float32)[None, None])
    return images


def normalisation_nodes(model: ov.Model) -> list[str]:
    """Operations before the space-to-depth: they stay in floating point, or darkness would be rounded away."""
    names = []
    for node in model.get_ordered_ops():
        if node.get_type_name() == "SpaceToDepth":
            return names
        if node.get_type_name() not in ("Parameter", "Constant", "Result"):
            names.append(node.get_friendly_name())
    raise SystemExit("the graph has no SpaceToDepth operation")


def tail_nodes(model: ov.Model) -> list[str]:
    """Of the global head, what follows its last convolution: the aggregation stays in floating point."""
    tail_types = ("ReduceL2", "Softmax", "Divide", "Subtract", "Multiply", "ReduceSum", "Power", "Sqrt")
    return [n.get_friendly_name() for n in model.get_ordered_ops() if n.get_type_name() in tail_types]


def main() -> None:
    """Command line."""
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("model", type=Path)
    p.add_argument("--data", type=Path, required=True)
    p.add_argument("--out", type=Path, required=True)
    a = p.parse_args()
    a.out.mkdir(parents=True, exist_ok=True)
    nncf.set_log_level(logging.ERROR)
    model = ov.Core().read_model(a.model)
    ov.save_model(model, a.out / "hfnet.xml", compress_to_fp16=True)
    kept = sorted(set(normalisation_nodes(model)) | set(tail_nodes(model)))
    quantised = nncf.quantize(
        model,
        nncf.Dataset(calibration_images(a.data)),
        subset_size=CALIBRATION_IMAGES,
        fast_bias_correction=False,
        ignored_scope=nncf.IgnoredScope(names=kept),
    )
    quantise_first_layer(quantised)
    ov.save_model(quantised, a.out / "hfnet_int8.xml", compress_to_fp16=True)


if __name__ == "__main__":
    main()
