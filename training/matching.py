# SPDX-License-Identifier: Apache-2.0
"""The matching benchmark: correct mutual nearest neighbours on pairs of frames with depth and pose."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
import openvino as ov
from numpy.typing import NDArray

from .data import Frame, lift, load_frame, project
from .graphs import BLOCKS, FEATURES, INPUT_STEP
from .inference import compile_on_cpu
from .teacher import sample

Array = NDArray[np.float32]
CORRECT_PIXELS = 8.0
INPUT_DEVIATION_FLOOR = 0.25  # grey levels, as in network.py


@dataclass(frozen=True)
class Detection:
    """Post-processing of the detector's output."""

    most: int = 1000
    radius: int = 4
    threshold: float = 0.0
    border: int = 8


@dataclass(frozen=True)
class Pair:
    """One row of pairs.txt."""

    first: int
    second: int
    dark: bool

    @property
    def block(self) -> str:
        """Name of the block it counts in."""
        return "gap 16, low light" if self.dark else f"gap {self.second - self.first}"


def read_pairs(path: Path) -> list[Pair]:
    """All pairs."""
    return [Pair(int(a), int(b), bool(int(c))) for a, b, c in np.loadtxt(path, dtype=int)]


def darken(grey: NDArray[np.uint8], gain: float, rng: np.random.Generator) -> NDArray[np.uint8]:
    """The project's low-light model: gamma 2.2, gain, 400 photons at full scale, read noise 0.006."""
    x = gain * (grey / 255.0) ** 2.2
    x = rng.poisson(x * 400) / 400.0 + rng.normal(0, 0.006, x.shape)
    return np.clip(x * 255, 0, 255).astype(np.uint8)


def blocks_of(grey: NDArray[np.uint8]) -> Array:
    """What the local part reads: the image at zero mean and unit deviation, blocks of 4x4 as channels."""
    pixels = grey.astype(np.float64)
    pixels = (pixels - pixels.mean()) / (pixels.std() + INPUT_DEVIATION_FLOOR)
    height, width = grey.shape
    blocks = pixels.reshape(height // 4, 4, width // 4, 4).transpose(1, 3, 0, 2)
    return blocks.reshape(1, 16, height // 4, width // 4).astype(np.float32)


class Network:
    """A model on the CPU, without silent bfloat16: ours, as one graph or with its global head in a file beside it, or an
    EdgePoint2 file."""

    def __init__(self, path: Path, threads: int = 2) -> None:
        self.model = compile_on_cpu(path, threads=threads)
        head = path.with_name(path.name.replace("hfnet", "hfnet_global"))
        self.names = [output.any_name for output in self.model.outputs]
        has_head = FEATURES in self.names and head != path and head.exists()
        self.head = compile_on_cpu(head, threads=threads) if has_head else None
        self.is_teacher = "score" in self.names
        self.has_global = self.head is not None or "global_descriptor" in self.names

    def __call__(self, grey: NDArray[np.uint8]) -> dict[str, Array]:
        """Outputs by name, but for a separate head's."""
        result = self.model([self._input(grey)])
        return {name: np.array(result[k]) for k, name in enumerate(self.names)}

    def _input(self, grey: NDArray[np.uint8]) -> NDArray:
        if self.is_teacher:
            return (grey.astype(np.float32) / 255)[None, None]
        if self.model.input(0).any_name != BLOCKS:
            return grey.astype(np.float32)[None, None]
        blocks = blocks_of(grey)
        if self.model.input(0).element_type == ov.Type.f32:
            return blocks
        return np.clip(np.rint(blocks / INPUT_STEP), -127, 127).astype(np.int8)

    def global_descriptor(self, grey: NDArray[np.uint8]) -> Array:
        """Of unit length."""
        out = self(grey)
        if self.head is not None:
            return np.array(self.head([out[FEATURES]])[0])[0]
        return out["global_descriptor"][0]


class Extractor:
    """Keypoints and descriptors of a grey image by one of our models, or by an EdgePoint2 file."""

    def __init__(self, network: Network, detection: Detection = Detection()) -> None:
        self.network, self.detection = network, detection
        self.is_teacher = network.is_teacher

    def scores(self, out: dict[str, Array]) -> Array:
        """Full-resolution scores."""
        if self.is_teacher:
            return out["score"][0, 0]
        logits = out["keypoint_logits"][0]
        odds = np.exp(logits - logits.max(0, keepdims=True))
        cells = odds[:64] / odds.sum(0, keepdims=True)
        _, h, w = cells.shape
        return cells.reshape(8, 8, h, w).transpose(2, 0, 3, 1).reshape(8 * h, 8 * w)

    def __call__(self, grey: NDArray[np.uint8]) -> tuple[Array, Array]:
        """Positions (N,2) and unit descriptors (N,D)."""
        out = self.network(grey)
        d, score = self.detection, self.scores(out)
        size = 2 * d.radius + 1
        peaks = (cv2.dilate(score, np.ones((size, size), np.uint8)) == score) & (
            score > (-5.0 if self.is_teacher else d.threshold)
        )
        b = d.border
        peaks[:b], peaks[-b:], peaks[:, :b], peaks[:, -b:] = False, False, False, False
        rows, columns = np.nonzero(peaks)
        order = np.argsort(-score[rows, columns], kind="stable")[: d.most]
        points = np.column_stack([columns[order], rows[order]]).astype(np.float32)
        field = out["desc" if self.is_teacher else "descriptors"][0]
        return points, sample(field, points[:, 0], points[:, 1], grey.shape[0] // field.shape[1])


def mutual_matches(first: Array, second: Array) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Index pairs of mutual nearest neighbours."""
    similarity = first @ second.T
    forward, backward = similarity.argmax(1), similarity.argmax(0)
    kept = np.flatnonzero(backward[forward] == np.arange(len(first)))
    return kept, forward[kept]


def correct_matches(a: Frame, b: Frame, first: tuple[Array, Array], second: tuple[Array, Array]) -> tuple[int, int]:
    """Number of correct matches, and of matches whose first keypoint has depth."""
    i, j = mutual_matches(first[1], second[1])
    moved, _ = project(b, lift(a, first[0][i]))
    error = np.linalg.norm(moved - second[0][j], axis=1)
    known = np.isfinite(lift(a, first[0][i])[:, 0])
    return int((error <= CORRECT_PIXELS).sum()), int(known.sum())


def run_pairs(extractor: Extractor, folder: Path, gain: float = 0.12) -> list[dict]:
    """Every pair's counts."""
    rng = np.random.default_rng(0)
    rows = []
    for pair in read_pairs(folder / "pairs.txt"):
        a, b = load_frame(folder, pair.first), load_frame(folder, pair.second)
        second = darken(b.grey, gain, rng) if pair.dark else b.grey
        good, known = correct_matches(a, b, extractor(a.grey), extractor(second))
        rows.append({"block": pair.block, "first": pair.first, "second": pair.second, "correct": good, "known": known})
    return rows
