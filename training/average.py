# SPDX-License-Identifier: Apache-2.0
"""The mean of the heads of two checkpoints, one of which was trained on from the other: better on unseen views than either.

python -m training.average FIRST SECOND OUT.pt
"""

from __future__ import annotations

import argparse
from pathlib import Path

import torch


def main() -> None:
    """Command line; all but the head is the second one's."""
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("first", type=Path)
    p.add_argument("second", type=Path)
    p.add_argument("out", type=Path)
    a = p.parse_args()
    first, second = (torch.load(f, weights_only=True) for f in (a.first, a.second))
    if first["head_config"] != second["head_config"] or first["step"] != second["step"]:
        raise SystemExit(f"{a.first} and {a.second} are heads of other sizes, or on other local parts")
    for name, value in second["head"].items():
        if value.is_floating_point():
            value.add_(first["head"][name]).div_(2)
    torch.save(second, a.out)


if __name__ == "__main__":
    main()
