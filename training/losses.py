# SPDX-License-Identifier: Apache-2.0
"""Losses of the local part: teacher keypoints, teacher descriptors, and agreement between two views."""

from __future__ import annotations

from dataclasses import dataclass

import torch
from torch import Tensor
from torch.nn import functional as F

from .network import CELL


@dataclass(frozen=True)
class LossOptions:
    """Weights and temperatures."""

    positive: float = 3.0  # weight of a keypoint cell against an empty one
    cosine: float = 2.0
    teacher_nce: float = 1.0
    view_nce: float = 2.0
    scale: float = 20.0  # inverse temperature
    near: float = 6.0  # pixels; closer keypoints are not negatives of one another


def describe(maps: Tensor, position: Tensor) -> Tensor:
    """Normalised descriptors (N,K,D) at pixel positions (N,K,2), pixel centres."""
    size = torch.tensor([maps.shape[3] * CELL, maps.shape[2] * CELL], dtype=torch.float32)
    grid = (position + 0.5) / size * 2 - 1
    picked = F.grid_sample(maps.float(), grid[:, None], align_corners=False, padding_mode="border")
    return F.normalize(picked[:, :, 0].transpose(1, 2), dim=2)


def contrast(one: Tensor, other: Tensor, position: Tensor, valid: Tensor, options: LossOptions) -> Tensor:
    """Symmetric InfoNCE between rows of two descriptor sets; `position` tells which negatives are too near."""
    logits = options.scale * one @ other.transpose(1, 2)
    near = torch.cdist(position, position) < options.near
    near &= ~torch.eye(near.shape[1], dtype=torch.bool)
    dead = near | ~valid[:, None, :] | ~valid[:, :, None]
    dead &= ~torch.eye(near.shape[1], dtype=torch.bool)
    logits = logits.masked_fill(dead, -1e4)
    match = torch.arange(logits.shape[1]).expand(logits.shape[0], -1)
    loss = F.cross_entropy(logits.transpose(1, 2), match, reduction="none")
    loss = 0.5 * (loss + F.cross_entropy(logits, match, reduction="none"))
    count = valid.sum(1).clamp(min=1)
    return ((loss * valid).sum(1) / count).mean()


def local_losses(logits: Tensor, maps: Tensor, batch: dict[str, Tensor], options: LossOptions) -> dict[str, Tensor]:
    """The four terms, unweighted. Images are interleaved: 2k and 2k+1 are the two views of pair k."""
    weight = torch.full((CELL * CELL + 1,), options.positive)
    weight[-1] = 1.0
    label = batch["label"].flatten(0, 1).long()
    position, target = batch["position"].flatten(0, 1), batch["target"].flatten(0, 1).float()
    valid = batch["valid"].flatten(0, 1)
    own = describe(maps, position)
    distance = ((1 - (own * target).sum(2)) * valid).sum(1) / valid.sum(1).clamp(min=1)
    moved = describe(maps[1::2], batch["moved"])
    return {
        "detector": F.cross_entropy(logits.float(), label, weight=weight),
        "cosine": distance.mean(),
        "teacher_nce": contrast(own, target, position, valid, options),
        "view_nce": contrast(own[0::2], moved, batch["moved"], batch["linked"], options),
    }


def total(terms: dict[str, Tensor], options: LossOptions) -> Tensor:
    """The weighted sum."""
    return (
        terms["detector"]
        + options.cosine * terms["cosine"]
        + options.teacher_nce * terms["teacher_nce"]
        + options.view_nce * terms["view_nce"]
    )
