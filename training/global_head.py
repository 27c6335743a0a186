# SPDX-License-Identifier: Apache-2.0
"""The global descriptor: more convolutions on the shared encoder, then NetVLAD with a learned reduction."""

from __future__ import annotations

from dataclasses import asdict, dataclass

import torch
from torch import Tensor, nn

from .network import LocalNet, NetworkConfig, RepBlock, conv_bn_relu

ASSIGNMENT_SHARPNESS = 20.0
REDUCTION = 4  # from the encoder's features to the maps that are aggregated


@dataclass(frozen=True)
class GlobalConfig:
    """Sizes of the global branch."""

    width: int = 96  # channels at stride 16
    deep: int = 128  # channels at stride 32, where the maps are aggregated
    blocks: int = 1  # RepVGG blocks there
    semantic: int = 112  # channels of the teacher's map that the branch reproduces
    clusters: int = 32
    descriptor: int = 256

    def as_dict(self) -> dict[str, int]:
        """Plain dictionary, for checkpoints."""
        return asdict(self)


def unit(x: Tensor, dim: int) -> Tensor:
    """L2-normalised along one axis."""
    return x / torch.sqrt((x * x).sum(dim, keepdim=True) + 1e-12)


class NetVlad(nn.Module):
    """Soft assignment of local vectors to clusters, sums of residuals, and a linear reduction."""

    def __init__(self, config: GlobalConfig) -> None:
        super().__init__()
        self.assign = nn.Conv2d(config.semantic, config.clusters, 1)
        self.centres = nn.Parameter(torch.randn(config.clusters, config.semantic))
        self.reduce = nn.Linear(config.clusters * config.semantic, config.descriptor)

    @torch.no_grad()
    def start_from(self, centres: Tensor) -> None:
        """Initialises the clusters by centres found by k-means on unit vectors."""
        self.centres.copy_(centres)
        self.assign.weight.copy_(2 * ASSIGNMENT_SHARPNESS * centres[:, :, None, None])
        self.assign.bias.copy_(-ASSIGNMENT_SHARPNESS * (centres * centres).sum(1))

    def aggregate(self, x: Tensor) -> Tensor:
        """(N,D,h,w) to unit vectors (N, clusters * D), before the reduction."""
        x = unit(x, 1)
        weight = torch.softmax(self.assign(x), 1).flatten(2)
        sums = weight @ x.flatten(2).transpose(1, 2)
        residual = sums - weight.sum(2, keepdim=True) * self.centres
        return unit(unit(residual, 2).flatten(1), 1)

    def forward(self, x: Tensor) -> Tensor:
        return unit(self.reduce(self.aggregate(x)), 1)


class GlobalHead(nn.Module):
    """Encoder features (N,64,H/8,W/8) to semantic maps at stride 32 and a descriptor."""

    def __init__(self, inputs: int, config: GlobalConfig = GlobalConfig()) -> None:
        super().__init__()
        self.config = config
        self.trunk = nn.Sequential(
            conv_bn_relu(inputs, config.width, 2),
            conv_bn_relu(config.width, config.deep, 2),
            *[RepBlock(config.deep) for _ in range(config.blocks)],
        )
        self.semantic = nn.Conv2d(config.deep, config.semantic, 1)
        self.vlad = NetVlad(config)

    def maps(self, features: Tensor) -> Tensor:
        """Semantic maps (N,112,H/32,W/32)."""
        return self.semantic(self.trunk(features))

    def forward(self, features: Tensor) -> Tensor:
        return self.vlad(self.maps(features))


class HfNet(nn.Module):
    """Local part and global head in one graph; what is not asked for can be cut away."""

    def __init__(self, network: NetworkConfig, head: GlobalConfig) -> None:
        super().__init__()
        self.local = LocalNet(network)
        self.head = GlobalHead(network.width, head)

    def outputs(self, image: Tensor) -> tuple[Tensor, ...]:
        """What is shipped: keypoint logits, descriptors, what the head reads, and the global descriptor."""
        logits, descriptors, features = self.local(image)
        return logits, descriptors, features, self.head(features)
