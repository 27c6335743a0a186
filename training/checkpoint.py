# SPDX-License-Identifier: Apache-2.0
"""Reading checkpoints, and cutting them down to what a later session needs to go on."""

from __future__ import annotations

import argparse
from pathlib import Path

import torch
from torch import nn

from .global_head import GlobalConfig, HfNet
from .network import LocalNet, NetworkConfig


def load_network(path: Path) -> nn.Module:
    """The network of a checkpoint with its running-mean weights."""
    saved = torch.load(path, weights_only=True)
    config = NetworkConfig(**saved["network"])
    if "head" not in saved:
        network = LocalNet(config)
        network.load_state_dict(saved["ema"])
        return network
    whole = HfNet(config, GlobalConfig(**saved["head_config"]))
    whole.local.load_state_dict(saved["ema"])
    whole.head.load_state_dict(saved["head"])
    return whole


def halved(state: dict[str, torch.Tensor]) -> dict[str, torch.Tensor]:
    """The floating-point entries at half precision."""
    return {k: v.half() if v.is_floating_point() else v for k, v in state.items()}


def main() -> None:
    """python -m training.checkpoint IN OUT: a small copy to go on from, of the running mean alone, at half precision."""
    p = argparse.ArgumentParser(description=main.__doc__)
    p.add_argument("source", type=Path)
    p.add_argument("out", type=Path)
    a = p.parse_args()
    saved = torch.load(a.source, weights_only=True)
    small = {k: saved[k] for k in ("step", "network", "head_config") if k in saved}
    small |= {k: halved(saved[k]) for k in ("ema", "head") if k in saved}
    torch.save(small, a.out)


if __name__ == "__main__":
    main()
