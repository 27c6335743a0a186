# SPDX-License-Identifier: Apache-2.0
"""Draws the curves of a run: python -m training.plot CURVES.csv OUT.svg"""

from __future__ import annotations

import csv
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot as plt

TERMS = ("detector", "cosine", "teacher_nce", "view_nce")


def read_curves(path: Path) -> dict[str, list[float]]:
    """Columns of the log."""
    with path.open(newline="") as file:
        rows = list(csv.DictReader(file))
    return {name: [float(row[name]) for row in rows] for name in rows[0]}


def draw(curves: dict[str, list[float]], out: Path) -> None:
    """A panel a loss term, over crops seen."""
    figure, axes = plt.subplots(1, len(TERMS), figsize=(12, 2.8), layout="constrained")
    for axis, name in zip(axes, TERMS, strict=True):
        axis.plot([c / 1000 for c in curves["crops"]], curves[name], linewidth=1)
        axis.set(title=name, xlabel="thousand crops")
        axis.set_ylim(0, 1.2 * sorted(curves[name])[int(0.9 * len(curves[name]))])
        axis.grid(alpha=0.3)
    figure.savefig(out)


def main() -> None:
    """Command line."""
    if len(sys.argv) != 3:
        raise SystemExit(__doc__)
    draw(read_curves(Path(sys.argv[1])), Path(sys.argv[2]))


if __name__ == "__main__":
    main()
