# SPDX-License-Identifier: Apache-2.0
"""The evaluation table of one or more models on redkitchen: JSON and Markdown.

python -m training.evaluate MODEL.xml... --data DIR --out TABLE.json
Runs in the `deploy` environment.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path

import numpy as np

from .data import LAST_TRAINING_FRAME
from .matching import Detection, Extractor, Network, run_pairs
from .recall import run_recall

REDKITCHEN = "7scenes_redkitchen"
Table = dict[str, dict[str, dict[str, float]]]


def summarise(rows: list[dict]) -> dict[str, dict[str, float]]:
    """Mean correct matches and share of correct ones a block; all pairs, those wholly in frames that were trained on (to
    choose options by), and those wholly in unseen ones."""
    table = {}
    for block in dict.fromkeys(r["block"] for r in rows):
        for part, kept in (
            ("all", lambda r: True),
            ("trained on", lambda r: r["second"] <= LAST_TRAINING_FRAME),
            ("held out", lambda r: r["first"] > LAST_TRAINING_FRAME),
        ):
            chosen = [r for r in rows if r["block"] == block and kept(r)]
            shares = [r["correct"] / max(r["known"], 1) for r in chosen]
            mean = float(np.mean([r["correct"] for r in chosen]))
            table[f"{block} ({part})"] = {"correct": mean, "share": float(np.mean(shares)), "pairs": len(chosen)}
    return table


def markdown(table: Table) -> str:
    """The table, a row a model."""
    blocks = list(next(iter(table.values())))
    lines = ["| model | " + " | ".join(blocks) + " |", "|" + "---|" * (len(blocks) + 1)]
    for name, row in table.items():
        cells = [f"{row[b]['correct']:.1f} ({row[b]['share']:.2f})" for b in blocks]
        lines.append(f"| {name} | " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def main() -> None:
    """Command line."""
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("models", type=Path, nargs="+")
    p.add_argument("--data", type=Path, required=True)
    p.add_argument("--out", type=Path)
    p.add_argument("--radius", type=int, default=Detection.radius, help="of non-maximum suppression, pixels")
    p.add_argument("--gain", type=float, default=0.12, help="of the low light")
    p.add_argument("--no-places", action="store_true", help="leave place recognition out")
    a = p.parse_args()
    table: Table = {}
    places: dict[str, dict[str, float]] = {}
    for path in a.models:
        network = Network(path)
        extractor = Extractor(network, Detection(radius=a.radius))
        table[path.stem] = summarise(run_pairs(extractor, a.data / REDKITCHEN, a.gain))
        print(markdown({path.stem: table[path.stem]}), flush=True)
        if network.has_global and not a.no_places:
            places[path.stem] = run_recall(network, a.data / REDKITCHEN, a.gain)
            print(path.stem, places[path.stem], flush=True)
    if a.out:
        a.out.write_text(json.dumps({"matches": table, "places": places}, indent=1) + "\n")
        a.out.with_suffix(".md").write_text(markdown(table))


if __name__ == "__main__":
    main()
