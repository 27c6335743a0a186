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


def main() -> None:
    """python -m training.checkpoint IN OUT: drops the optimiser's state; training can go on from OUT."""
    p = argparse.ArgumentParser(description=main.__doc__)
    p.add_argument("source", type=Path)
    p.add_argument("out", type=Path)
    a = p.parse_args()
    saved = torch.load(a.source, weights_only=True)
    torch.save({k: v for k, v in saved.items() if k != "optimiser"}, a.out)


if __name__ == "__main__":
    main()
