# SPDX-License-Identifier: Apache-2.0
"""Worker processes that turn views into training samples: teacher targets, degraded crops, correspondences."""

from __future__ import annotations

import multiprocessing as mp
import queue as queues
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from .data import Frame, Image, PhotoPairs, SequencePairs, View
from .degrade import degrade
from .teacher import LocalTeacher, TargetOptions, cell_labels, keypoints, sample

Sample = dict[str, NDArray]


@dataclass(frozen=True)
class SampleOptions:
    """Sizes and shares of the sample stream."""

    height: int = 256
    width: int = 320
    group: int = 4  # pairs a teacher call
    sequence_share: float = 0.25
    seed: int = 0


def pad(values: NDArray, length: int) -> NDArray:
    """Zero rows up to a fixed length."""
    out = np.zeros((length, *values.shape[1:]), values.dtype)
    out[: len(values)] = values[:length]
    return out


def build(view: View, maps: NDArray, scores: NDArray, options: TargetOptions, rng: np.random.Generator) -> Sample:
    """One training sample from a pair of clean crops and the teacher's outputs on them."""
    images = (view.first, view.second)
    height, width = view.first.shape
    out: dict[str, list[NDArray]] = {"label": [], "position": [], "target": [], "valid": []}
    for field, score in zip(maps, scores, strict=True):
        rows, columns, _ = keypoints(score, options)
        out["label"].append(cell_labels(rows, columns, height, width))
        chosen = np.sort(rng.permutation(len(rows))[: options.kept])
        points = np.column_stack([columns[chosen], rows[chosen]]).astype(np.float32)
        described = sample(field, points[:, 0], points[:, 1], height // field.shape[1])
        out["position"].append(pad(points, options.kept))
        out["target"].append(pad(described.astype(np.float16), options.kept))
        out["valid"].append(np.arange(options.kept) < len(points))
    stacked = {name: np.stack(values) for name, values in out.items()}
    stacked["image"] = np.stack([degrade(i, rng) for i in images])
    moved = view.transfer(stacked["position"][0])
    inside = (moved[:, 0] > 4) & (moved[:, 0] < width - 5) & (moved[:, 1] > 4) & (moved[:, 1] < height - 5)
    stacked["linked"] = stacked["valid"][0] & inside
    stacked["moved"] = np.where(stacked["linked"][:, None], np.nan_to_num(moved), 0).astype(np.float32)
    return stacked


class SampleWorker:
    """Makes groups of samples; one lives in each worker process."""

    def __init__(self, photos: list[Image], frames: list[Frame], model: Path, options: SampleOptions) -> None:
        self.options, self.targets = options, TargetOptions()
        self.photo_pairs = PhotoPairs(photos, options.height, options.width)
        self.sequence_pairs = SequencePairs(frames, options.height, options.width)
        self.model = model

    def run(self, queue: mp.Queue, number: int) -> None:
        """Fills the queue for ever."""
        cv2.setNumThreads(0)
        o = self.options
        rng = np.random.default_rng([o.seed, number])
        teacher = LocalTeacher(self.model, 2 * o.group, o.height, o.width)
        while True:
            views = [self._view(rng) for _ in range(o.group)]
            maps, scores = teacher(np.stack([i for v in views for i in (v.first, v.second)]))
            for k, view in enumerate(views):
                part = slice(2 * k, 2 * k + 2)
                queue.put(build(view, maps[part], scores[part], self.targets, rng))

    def _view(self, rng: np.random.Generator) -> View:
        from_sequence = rng.random() < self.options.sequence_share
        return self.sequence_pairs(rng) if from_sequence else self.photo_pairs(rng)


class SampleStream:
    """Batches from worker processes (forked, so that the images are shared)."""

    def __init__(self, worker: SampleWorker, processes: int, stream_seed: int, depth: int = 32) -> None:
        context = mp.get_context("fork")
        self.queue: mp.Queue = context.Queue(depth)
        numbers = [stream_seed * 16 + k for k in range(processes)]
        self.processes = [context.Process(target=worker.run, args=(self.queue, n), daemon=True) for n in numbers]
        for process in self.processes:
            process.start()

    def batch(self, pairs: int) -> Sample:
        """The next `pairs` samples, stacked; RuntimeError if a worker process has ended."""
        samples = [self._next() for _ in range(pairs)]
        return {name: np.stack([s[name] for s in samples]) for name in samples[0]}

    def _next(self) -> Sample:
        while True:
            for process in self.processes:
                if not process.is_alive():
                    raise RuntimeError(f"sample worker {process.name} ended with exit code {process.exitcode}")
            try:
                return self.queue.get(timeout=10)
            except queues.Empty:
                continue

    def close(self) -> None:
        """Ends the worker processes."""
        for process in self.processes:
            process.terminate()
