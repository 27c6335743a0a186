# SPDX-License-Identifier: Apache-2.0
"""Writes the running-mean weights of a checkpoint as an ONNX graph of plain convolutions.

python -m training.export CHECKPOINT OUT.onnx
"""

from __future__ import annotations

import argparse
import warnings
from pathlib import Path

import torch
from torch import Tensor, nn

from .checkpoint import load_network
from .network import fuse

OPSET = 13


class NamedOutputs(nn.Module):
    """The outputs that are shipped, in the manifest's order."""

    def __init__(self, network: nn.Module) -> None:
        super().__init__()
        self.network = network

    def forward(self, image: Tensor) -> tuple[Tensor, ...]:
        return self.network.outputs(image)


def _space_to_depth(graph, image, factor):
    """With one input channel, PixelUnshuffle and SpaceToDepth are the same; the latter has a fast kernel."""
    return graph.op("SpaceToDepth", image, blocksize_i=torch.onnx.symbolic_helper._get_const(factor, "i", "factor"))


def main() -> None:
    """Command line."""
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("checkpoint", type=Path)
    p.add_argument("out", type=Path)
    a = p.parse_args()
    network = load_network(a.checkpoint).eval()
    image = torch.rand(1, 1, 96, 128) * 255
    with torch.no_grad():
        before = network.outputs(image)
        graph = NamedOutputs(fuse(network))
        worst = max(float((x - y).abs().max()) for x, y in zip(before, graph(image), strict=True))
    if worst > 1e-2:
        raise SystemExit(f"fusing the branches changed the outputs by {worst}")
    names = ["keypoint_logits", "descriptors", "features", "global_descriptor"][: len(before)]
    axes = {name: {2: f"{name}_h", 3: f"{name}_w"} for name in ("image", "keypoint_logits", "descriptors", "features")}
    torch.onnx.register_custom_op_symbolic("aten::pixel_unshuffle", _space_to_depth, OPSET)
    options = {
        "input_names": ["image"],
        "output_names": names,
        "dynamic_axes": {k: axes[k] for k in axes if k == "image" or k in names},
        "opset_version": OPSET,
    }
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        torch.onnx.export(graph, (image,), str(a.out), dynamo=False, **options)
    print(f"{a.out}: outputs {names}, fused branches differ by {worst:.1e}")


if __name__ == "__main__":
    main()
