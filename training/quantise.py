# SPDX-License-Identifier: Apache-2.0
"""ONNX graph to OpenVINO IR, local part and global head: FP16-stored weights, and INT8 by post-training quantisation.

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
from .graphs import (
    FEATURES,
    cut_head,
    cut_local,
    feature_range,
    float_features,
    head_input,
    integer_features,
    integer_input,
)
from .inference import compile_on_cpu
from .matching import blocks_of
from .rounding import round_weights

Tensor = NDArray[np.float32]
CALIBRATION_IMAGES = 240
DARK_SHARE = 0.35


def calibration_files(data: Path, count: int) -> list[Path]:
    """Training photos and training frames, half and half."""
    photos = photo_files(data)
    frames = [data / f"7scenes_redkitchen/frame-{n:06d}.color.jpg" for n in range(0, LAST_TRAINING_FRAME + 1, 2)]
    half = count // 2
    return [photos[i] for i in np.linspace(0, len(photos) - 1, half).astype(int)] + [
        frames[i] for i in np.linspace(0, len(frames) - 1, count - half).astype(int)
    ]


def calibration_blocks(data: Path, count: int) -> list[Tensor]:
    """Inputs of the local part, from images as they are, dark and noisy, or otherwise degraded."""
    rng = np.random.default_rng(0)
    inputs = []
    for file in calibration_files(data, count):
        grey = cv2.resize(cv2.imread(str(file), cv2.IMREAD_GRAYSCALE), (640, 480)).astype(np.float32) / 255
        draw = rng.random()
        if draw < DARK_SHARE:
            grey = low_light(grey, rng)
        elif draw < DARK_SHARE + 0.25:
            grey = photometric(grey, rng)
        inputs.append(blocks_of(np.clip(np.floor(grey * 255), 0, 255).astype(np.uint8)))
    return inputs


def tail_nodes(model: ov.Model) -> list[str]:
    """Of the global head, what follows its last convolution: the aggregation stays in floating point."""
    tail_types = ("ReduceL2", "Softmax", "Divide", "Subtract", "Multiply", "ReduceSum", "Power", "Sqrt")
    return [n.get_friendly_name() for n in model.get_ordered_ops() if n.get_type_name() in tail_types]


def quantised(model: ov.Model, inputs: list[Tensor], kept: list[str]) -> ov.Model:
    """INT8 by calibration; `kept` stays in floating point."""
    return nncf.quantize(
        model,
        nncf.Dataset(inputs),
        subset_size=len(inputs),
        fast_bias_correction=False,
        ignored_scope=nncf.IgnoredScope(names=kept),
    )


def save(model: ov.Model, path: Path) -> None:
    """Weights as FP16 where they are not integers."""
    ov.save_model(model, path, compress_to_fp16=True)


def main() -> None:
    """Command line."""
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("model", type=Path)
    p.add_argument("--data", type=Path, required=True)
    p.add_argument("--out", type=Path, required=True)
    p.add_argument("--images", type=int, default=CALIBRATION_IMAGES, help="for the calibration")
    a = p.parse_args()
    a.out.mkdir(parents=True, exist_ok=True)
    nncf.set_log_level(logging.ERROR)
    whole = ov.Core().read_model(a.model)
    blocks = calibration_blocks(a.data, a.images)

    local, head = cut_local(whole), cut_head(whole)
    small_local = quantised(local, blocks, [])
    round_weights(small_local, local, blocks[::2])
    run = compile_on_cpu(small_local)
    features = [np.array(run([b])[FEATURES]) for b in blocks[::2]]
    small_head = quantised(head, features, tail_nodes(head))
    round_weights(small_head, head, features)

    top = feature_range(small_local)
    integer_input(small_local)
    integer_features(small_local)
    head_input(small_head, top)
    float_features(local)
    head_input(head, None)
    save(local, a.out / "hfnet.xml")
    save(head, a.out / "hfnet_global.xml")
    save(small_local, a.out / "hfnet_int8.xml")
    save(small_head, a.out / "hfnet_global_int8.xml")


if __name__ == "__main__":
    main()
