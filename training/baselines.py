# SPDX-License-Identifier: Apache-2.0
"""Place recognition without training, to hold the global head against: VLAD over other networks' features.

python -m training.baselines --data DIR --teacher EDGEPOINT2.onnx [--json FILE]
32 clusters by k-means on the database's features; residuals normalised by cluster, then as a whole.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor

from .evaluate import REDKITCHEN
from .global_data import semantic_teacher
from .global_head import unit
from .recall import Images, recall_table
from .teacher import LocalTeacher
from .train_global import kmeans

CLUSTERS = 32
Features = Callable[[NDArray[np.uint8]], Tensor]  # an image's features, a row a place


def edgepoint_features(model: Path) -> Features:
    """EdgePoint2's descriptors, one of sixteen."""
    teacher = LocalTeacher(model, 1, 480, 640)

    def features(grey: NDArray[np.uint8]) -> Tensor:
        field = torch.from_numpy(teacher(grey[None])[0][0])
        return unit(field[:, ::4, ::4].flatten(1).T.contiguous(), 1)

    return features


def efficientnet_features() -> Features:
    """EfficientNet-Lite0's last map at stride 16."""
    network = semantic_teacher()

    def features(grey: NDArray[np.uint8]) -> Tensor:
        image = (torch.from_numpy(grey).float()[None, None] - 127) / 128
        with torch.inference_mode():
            return unit(network(image.expand(-1, 3, -1, -1))[0].flatten(1).T.contiguous(), 1)

    return features


def vlad(features: Tensor, centres: Tensor) -> NDArray[np.float32]:
    """The descriptor of an image."""
    nearest = torch.cdist(features, centres).argmin(1)
    sums = torch.zeros_like(centres).index_add_(0, nearest, features - centres[nearest])
    return unit(unit(sums, 1).flatten(), 0).numpy()


def describe_by(features: Features) -> Callable[[Images], NDArray[np.float32]]:
    """Descriptors of images; the first images ever seen, which are the database, make the clusters."""
    centres: list[Tensor] = []

    def describe(images: Images) -> NDArray[np.float32]:
        found = [features(image) for image in images]
        if not centres:
            torch.manual_seed(0)
            sample = torch.cat(found)
            centres.append(kmeans(sample[torch.randperm(len(sample))[:40000]], CLUSTERS))
        return np.stack([vlad(f, centres[0]) for f in found])

    return describe


def main() -> None:
    """Command line."""
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("--data", type=Path, required=True)
    p.add_argument("--teacher", type=Path, required=True)
    p.add_argument("--json", type=Path)
    a = p.parse_args()
    table = {}
    for name, made in (
        ("VLAD over EfficientNet-Lite0", efficientnet_features),
        (f"VLAD over {a.teacher.stem}", lambda: edgepoint_features(a.teacher)),
    ):
        table[name] = recall_table(describe_by(made()), a.data / REDKITCHEN)
        print(name, table[name], flush=True)
    if a.json:
        a.json.write_text(json.dumps(table, indent=1) + "\n")


if __name__ == "__main__":
    main()
