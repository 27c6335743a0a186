# SPDX-License-Identifier: Apache-2.0
"""The feature network: a shared encoder of plain 3x3 convolutions, a detector head and a descriptor head.

Plain convolutions quantise well and are what the CPU runs fastest; while training, the blocks carry RepVGG branches
(3x3 + 1x1 + identity), which `fuse` folds into one convolution each.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass

import torch
from torch import Tensor, nn
from torch.nn import functional as F

CELL = 8
INPUT_DEVIATION_FLOOR = 0.25  # grey levels; keeps a constant image from dividing by zero


@dataclass(frozen=True)
class NetworkConfig:
    """Sizes of the local part: channels at stride 4 and 8, RepVGG blocks there, channels inside the two heads."""

    stem: int = 32
    stem_blocks: int = 0
    width: int = 64
    blocks: int = 4
    detector_head: int = 32
    descriptor_head: int = 64
    descriptor: int = 64

    def as_dict(self) -> dict[str, int]:
        """Plain dictionary, for checkpoints and manifests."""
        return asdict(self)


def conv_bn_relu(inputs: int, outputs: int, stride: int = 1) -> nn.Sequential:
    """3x3 convolution, batch normalisation, ReLU."""
    return nn.Sequential(
        nn.Conv2d(inputs, outputs, 3, stride, 1, bias=False), nn.BatchNorm2d(outputs), nn.ReLU(inplace=True)
    )


class RepBlock(nn.Module):
    """3x3 + 1x1 + identity branches, each batch-normalised, summed before the ReLU."""

    def __init__(self, channels: int) -> None:
        super().__init__()
        self.conv3 = nn.Conv2d(channels, channels, 3, 1, 1, bias=False)
        self.norm3 = nn.BatchNorm2d(channels)
        self.conv1 = nn.Conv2d(channels, channels, 1, bias=False)
        self.norm1 = nn.BatchNorm2d(channels)
        self.norm0 = nn.BatchNorm2d(channels)

    def forward(self, x: Tensor) -> Tensor:
        return F.relu(self.norm3(self.conv3(x)) + self.norm1(self.conv1(x)) + self.norm0(x))

    def fused(self) -> nn.Sequential:
        """One convolution with the same outputs (in evaluation mode)."""
        weight, bias = _fold(self.conv3.weight, self.norm3)
        w1, b1 = _fold(F.pad(self.conv1.weight, (1, 1, 1, 1)), self.norm1)
        identity = torch.eye(weight.shape[0])[:, :, None, None]
        w0, b0 = _fold(F.pad(identity, (1, 1, 1, 1)), self.norm0)
        return nn.Sequential(_conv(weight + w1 + w0, bias + b1 + b0), nn.ReLU())


def _fold(weight: Tensor, norm: nn.BatchNorm2d) -> tuple[Tensor, Tensor]:
    """Weight and bias of a convolution with its batch normalisation folded in."""
    scale = norm.weight / torch.sqrt(norm.running_var + norm.eps)
    return weight * scale[:, None, None, None], norm.bias - norm.running_mean * scale


def _conv(weight: Tensor, bias: Tensor, stride: int = 1) -> nn.Conv2d:
    outputs, inputs, size, _ = weight.shape
    conv = nn.Conv2d(inputs, outputs, size, stride, size // 2)
    conv.weight.data.copy_(weight)
    conv.bias.data.copy_(bias)
    return conv


def normalise(image: Tensor) -> Tensor:
    """Zero mean, unit deviation, over the image: exposure and its scale drop out."""
    centred = image - image.mean((1, 2, 3), keepdim=True)
    deviation = torch.sqrt((centred * centred).mean((1, 2, 3), keepdim=True))
    return centred / (deviation + INPUT_DEVIATION_FLOOR)


class LocalNet(nn.Module):
    """Grey image (N,1,H,W; 0..255) to keypoint logits (N,65,H/8,W/8), descriptors (N,D,H/8,W/8) and features."""

    def __init__(self, config: NetworkConfig = NetworkConfig()) -> None:
        super().__init__()
        c = self.config = config
        self.encoder = nn.Sequential(
            nn.PixelUnshuffle(4),
            conv_bn_relu(16, c.stem),
            *[RepBlock(c.stem) for _ in range(c.stem_blocks)],
            conv_bn_relu(c.stem, c.width, 2),
            *[RepBlock(c.width) for _ in range(c.blocks)],
        )
        self.detector = nn.Sequential(
            conv_bn_relu(c.width, c.detector_head), nn.Conv2d(c.detector_head, CELL * CELL + 1, 1)
        )
        self.descriptor = nn.Sequential(
            conv_bn_relu(c.width, c.descriptor_head), nn.Conv2d(c.descriptor_head, c.descriptor, 1)
        )

    def forward(self, image: Tensor) -> tuple[Tensor, Tensor, Tensor]:
        features = self.encoder(normalise(image))
        return self.detector(features), self.descriptor(features), features

    def outputs(self, image: Tensor) -> tuple[Tensor, ...]:
        """What is shipped: keypoint logits and descriptors."""
        return self(image)[:2]


def fuse(module: nn.Module) -> nn.Module:
    """Copy-free, in-place: folds every RepVGG block and batch normalisation below `module` into convolutions."""
    for name, child in list(module.named_children()):
        if isinstance(child, RepBlock):
            setattr(module, name, child.fused())
        elif isinstance(child, nn.Sequential) and len(child) == 3 and isinstance(child[1], nn.BatchNorm2d):
            weight, bias = _fold(child[0].weight, child[1])
            setattr(module, name, nn.Sequential(_conv(weight, bias, child[0].stride[0]), nn.ReLU()))
        else:
            fuse(child)
    return module
