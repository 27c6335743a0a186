# SPDX-License-Identifier: Apache-2.0
"""Starts a smaller network from a trained larger one, so that training it takes a fraction of the time.

python -m training.narrow CHECKPOINT OUT.pt [--blocks N] [--stem-blocks N] [--detector-head N]
Blocks are dropped from the end; of a head's inner channels, those that weigh most in its output are kept.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import torch
from torch import Tensor

from .network import LocalNet, NetworkConfig

State = dict[str, Tensor]


def larger_config(saved: dict[str, int]) -> NetworkConfig:
    """Sizes in a checkpoint; the first ones had one size for both heads and one block at stride 4."""
    if "head" not in saved:
        return NetworkConfig(**saved)
    heads = {"detector_head": saved["head"], "descriptor_head": saved["head"]}
    return NetworkConfig(**{k: v for k, v in saved.items() if k != "head"}, stem_blocks=1, **heads)


def keep_blocks(state: State, was: NetworkConfig, now: NetworkConfig) -> State:
    """The encoder with the first blocks of each stride."""
    layers = [0, 1, *range(2, 2 + now.stem_blocks), 2 + was.stem_blocks]
    layers += range(3 + was.stem_blocks, 3 + was.stem_blocks + now.blocks)
    kept = {k: v for k, v in state.items() if not k.startswith("encoder.")}
    for new, old in enumerate(layers):
        prefix = f"encoder.{old}."
        kept |= {f"encoder.{new}.{k[len(prefix):]}": v for k, v in state.items() if k.startswith(prefix)}
    return kept


def keep_channels(state: State, head: str, count: int) -> State:
    """The head with its `count` strongest inner channels."""
    last = state[f"{head}.1.weight"]
    scale = state[f"{head}.0.1.weight"].abs()
    rows = (last.float().square().sum((0, 2, 3)).sqrt() * scale).topk(count).indices.sort().values
    kept = dict(state)
    for name in ("0.0.weight", "0.1.weight", "0.1.bias", "0.1.running_mean", "0.1.running_var"):
        kept[f"{head}.{name}"] = state[f"{head}.{name}"][rows]
    kept[f"{head}.1.weight"] = last[:, rows]
    return kept


def main() -> None:
    """Command line."""
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("source", type=Path)
    p.add_argument("out", type=Path)
    p.add_argument("--blocks", type=int, default=NetworkConfig.blocks)
    p.add_argument("--stem-blocks", type=int, default=NetworkConfig.stem_blocks)
    p.add_argument("--detector-head", type=int, default=NetworkConfig.detector_head)
    a = p.parse_args()
    saved = torch.load(a.source, weights_only=True)
    was = larger_config(saved["network"])
    now = NetworkConfig(stem_blocks=a.stem_blocks, blocks=a.blocks, detector_head=a.detector_head)
    state = keep_channels(keep_blocks(saved["ema"], was, now), "detector", now.detector_head)
    state = {k: v.float() if v.is_floating_point() else v for k, v in state.items()}
    LocalNet(now).load_state_dict(state)  # refuses what does not fit
    torch.save({"ema": state, "step": 0, "network": now.as_dict()}, a.out)
    print(f"{a.out}: {sum(v.numel() for v in state.values())} numbers, {now}")


if __name__ == "__main__":
    main()
