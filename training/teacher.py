# SPDX-License-Identifier: Apache-2.0
"""The local teacher (EdgePoint2) run by OpenVINO, and the targets read off its outputs."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
import openvino as ov
from numpy.typing import NDArray

from .inference import compile_on_cpu

Array = NDArray[np.float32]
DUSTBIN = 64


@dataclass(frozen=True)
class TargetOptions:
    """How keypoints are chosen on a crop."""

    most: int = 320  # maxima that count as keypoints
    kept: int = 256  # of these, how many carry descriptors into the loss
    threshold: float = -5.0
    border: int = 8


class LocalTeacher:
    """EdgePoint2 at a fixed batch and crop size; bf16 gives the same keypoints (496 of 500) at half the time."""

    def __init__(self, model: Path, batch: int, height: int, width: int, precision: str = "bf16") -> None:
        graph = ov.Core().read_model(str(model))
        graph.reshape([batch, 1, height, width])
        compiled = compile_on_cpu(graph, precision, threads=1)
        names = [output.any_name for output in compiled.outputs]
        self._descriptors, self._scores = names.index("desc"), names.index("score")
        self._request = compiled.create_infer_request()

    def __call__(self, images: NDArray[np.uint8]) -> tuple[Array, Array]:
        """(N,H,W) grey to descriptor maps (N,D,H/4,W/4) and score maps (N,H,W)."""
        out = self._request.infer([images[:, None].astype(np.float32) / np.float32(255)])
        return np.array(out[self._descriptors]), np.array(out[self._scores])[:, 0]


def keypoints(score: Array, options: TargetOptions) -> tuple[NDArray[np.intp], NDArray[np.intp], Array]:
    """Rows, columns and scores of the strongest local maxima (5x5), strongest first."""
    peaks = (cv2.dilate(score, np.ones((5, 5), np.uint8)) == score) & (score >= options.threshold)
    b = options.border
    peaks[:b], peaks[-b:], peaks[:, :b], peaks[:, -b:] = False, False, False, False
    rows, columns = np.nonzero(peaks)
    strength = score[rows, columns]
    order = np.argsort(-strength)[: options.most]
    return rows[order], columns[order], strength[order]


def cell_labels(rows: NDArray[np.intp], columns: NDArray[np.intp], height: int, width: int) -> NDArray[np.uint8]:
    """65-way label of each 8x8 cell; keypoints come strongest first, so the strongest of a cell stays."""
    labels = np.full((height // 8, width // 8), DUSTBIN, np.uint8)
    inside = (rows % 8) * 8 + columns % 8
    labels[rows[::-1] // 8, columns[::-1] // 8] = inside[::-1]
    return labels


def sample(field: Array, x: Array, y: Array, stride: int) -> Array:
    """Bilinear samples (N,D), L2-normalised, of a (D,h,w) map at pixel-centre coordinates of the full image."""
    grid_x = ((x + 0.5) / stride - 0.5).astype(np.float32)
    grid_y = ((y + 0.5) / stride - 0.5).astype(np.float32)
    depth, height, width = field.shape
    x0 = np.clip(np.floor(grid_x), 0, width - 2).astype(np.intp)
    y0 = np.clip(np.floor(grid_y), 0, height - 2).astype(np.intp)
    fx, fy = np.clip(grid_x - x0, 0, 1), np.clip(grid_y - y0, 0, 1)
    flat = field.reshape(depth, -1)
    corner = y0 * width + x0
    out = flat[:, corner] * ((1 - fx) * (1 - fy)) + flat[:, corner + 1] * (fx * (1 - fy))
    out += flat[:, corner + width] * ((1 - fx) * fy) + flat[:, corner + width + 1] * (fx * fy)
    out = out.T
    return out / np.maximum(np.linalg.norm(out, axis=1, keepdims=True), 1e-6)
