# SPDX-License-Identifier: Apache-2.0
"""Place recognition on redkitchen: early frames are the database, late ones the queries."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from .data import LAST_TRAINING_FRAME, Frame, load_frame
from .matching import Network, darken

Array = NDArray[np.float32]
Images = list[NDArray[np.uint8]]
NEAR_METRES, NEAR_DEGREES = 0.5, 30.0


def same_place(queries: list[Frame], database: list[Frame]) -> NDArray[np.bool_]:
    """Which database frame shows a query's place."""
    a, b = np.array([f.pose for f in queries]), np.array([f.pose for f in database])
    distance = np.linalg.norm(a[:, None, :3, 3] - b[None, :, :3, 3], axis=2)
    trace = np.einsum("iab,jab->ij", a[:, :3, :3], b[:, :3, :3])
    angle = np.rad2deg(np.arccos(np.clip((trace - 1) / 2, -1, 1)))
    return (distance < NEAR_METRES) & (angle < NEAR_DEGREES)


def recall(near: NDArray[np.bool_], queries: Array, database: Array, best: int) -> float:
    """Share of the queries with a right answer among the best few."""
    order = np.argsort(-(queries @ database.T), axis=1)[:, :best]
    return float(np.take_along_axis(near, order, 1).any(1).mean())


def recall_table(describe: Callable[[Images], Array], folder: Path, gain: float = 0.12) -> dict[str, float]:
    """Recall at 1 and 5, as it is and with the query in low light. The database is described first."""
    database = [load_frame(folder, n) for n in range(0, LAST_TRAINING_FRAME + 1, 2)]
    queries = [load_frame(folder, n) for n in range(LAST_TRAINING_FRAME + 2, 1000, 2)]
    near = same_place(queries, database)
    queries = [q for q, row in zip(queries, near, strict=True) if row.any()]
    near = near[near.any(1)]
    rng = np.random.default_rng(0)
    known = describe([f.grey for f in database])
    table: dict[str, float] = {"queries": len(queries)}
    for name, images in (
        ("", [q.grey for q in queries]),
        (", low light", [darken(q.grey, gain, rng) for q in queries]),
    ):
        asked = describe(images)
        for best in (1, 5):
            table[f"recall@{best}{name}"] = recall(near, asked, known, best)
    return table


def run_recall(network: Network, folder: Path, gain: float = 0.12) -> dict[str, float]:
    """The table of one of our networks."""
    return recall_table(lambda images: np.stack([network.global_descriptor(i) for i in images]), folder, gain)
