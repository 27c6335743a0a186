# SPDX-License-Identifier: Apache-2.0
"""Trains the global head on a finished local part: first the semantic teacher's maps, then places.

python -m training.train_global --data DIR --local CHECKPOINT --run DIR [--head CHECKPOINT]
"""

from __future__ import annotations

import argparse
import os
import time
from pathlib import Path

import numpy as np
import torch
from torch import Tensor, nn
from torch.nn import functional as F

from .data import load_photos, load_sequence, photo_files
from .global_data import FeatureSet, Places, encoder_features, photo_crop, places_of, teacher_maps
from .global_head import REDUCTION, GlobalConfig, GlobalHead, unit
from .network import LocalNet, NetworkConfig, normalise

SCALE = 12.0  # inverse temperature of the place loss


def arguments() -> argparse.Namespace:
    """Command line."""
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("--data", type=Path, required=True)
    p.add_argument("--local", type=Path, required=True, help="checkpoint of the local part")
    p.add_argument("--run", type=Path, required=True)
    p.add_argument("--head", type=Path, help="checkpoint to start the head from")
    p.add_argument("--trunk", type=Path, help="checkpoint whose head's first convolutions to start from")
    p.add_argument("--photos", type=int, default=1200)
    p.add_argument("--variants", type=int, default=2, help="views of a photo; frames get twice as many")
    p.add_argument("--semantic-steps", type=int, default=1000)
    p.add_argument("--place-steps", type=int, default=600)
    p.add_argument("--rate", type=float, default=2e-3)
    p.add_argument("--threads", type=int, default=1)
    p.add_argument("--seed", type=int, default=0)
    return p.parse_args()


class Encoder(nn.Module):
    """Images to shared features, by the running-mean weights of a local checkpoint."""

    def __init__(self, checkpoint: dict) -> None:
        super().__init__()
        local = LocalNet(NetworkConfig(**checkpoint["network"]))
        local.load_state_dict(checkpoint["ema"])
        self.encoder = local.encoder.eval().to(memory_format=torch.channels_last)

    def forward(self, image: Tensor) -> Tensor:
        return self.encoder(normalise(image))


def window(maps: Tensor, teacher: Tensor | None, height: int, width: int) -> tuple[Tensor, Tensor | None]:
    """A random part of feature maps, whole cells of the head's maps (and the same part of maps at half their size)."""
    y = REDUCTION * int(torch.randint((maps.shape[2] - height) // REDUCTION + 1, ()))
    x = REDUCTION * int(torch.randint((maps.shape[3] - width) // REDUCTION + 1, ()))
    part = maps[:, :, y : y + height, x : x + width]
    if teacher is None:
        return part, None
    return part, teacher[:, :, y // 2 : (y + height) // 2, x // 2 : (x + width) // 2]


def map_loss(found: Tensor, teacher: Tensor) -> Tensor:
    """One minus the cosine, over all places; the teacher's finer maps are averaged."""
    coarse = F.adaptive_avg_pool2d(teacher.float(), found.shape[2:])
    return 1 - F.cosine_similarity(found.float(), coarse, dim=1).mean()


def place_loss(vectors: Tensor, same: Tensor, other: Tensor) -> Tensor:
    """InfoNCE with several positives a query."""
    logits = SCALE * vectors @ vectors.T
    rivals = torch.logsumexp(logits.masked_fill(~other, -1e4), 1, keepdim=True)
    each = F.softplus(rivals - logits)
    return (each * same).sum() / same.sum().clamp(min=1)


def kmeans(points: Tensor, clusters: int, rounds: int = 25) -> Tensor:
    """Centres of unit vectors."""
    centres = points[torch.randperm(len(points))[:clusters]].clone()
    for _ in range(rounds):
        nearest = torch.cdist(points, centres).argmin(1)
        sums = torch.zeros_like(centres).index_add_(0, nearest, points)
        count = torch.bincount(nearest, minlength=clusters)[:, None]
        centres = torch.where(count > 0, sums / count.clamp(min=1), centres)
    return centres


class GlobalTrainer:
    """The head, its data and its two stages."""

    def __init__(self, args: argparse.Namespace, photos: FeatureSet, frames: FeatureSet, places: Places) -> None:
        self.args, self.photos, self.frames, self.places = args, photos, frames, places
        self.head = GlobalHead(photos.features.shape[2], GlobalConfig()).to(memory_format=torch.channels_last)
        self.crops_seen = 0

    def pick(self, data: FeatureSet, rows: Tensor) -> Tensor:
        """Random variants of the given images."""
        variant = torch.randint(data.features.shape[0], (len(rows),))
        return data.features[variant, rows].contiguous(memory_format=torch.channels_last)

    def step(self, optimiser: torch.optim.Optimizer, loss: Tensor) -> float:
        """One update."""
        optimiser.zero_grad()
        loss.backward()
        nn.utils.clip_grad_norm_(self.head.parameters(), 5.0)
        optimiser.step()
        return float(loss.detach())

    def optimiser(self, rate: float, steps: int) -> tuple[torch.optim.Optimizer, torch.optim.lr_scheduler.LRScheduler]:
        """AdamW with a one-cycle schedule."""
        made = torch.optim.AdamW(self.head.parameters(), lr=rate, weight_decay=1e-4)
        return made, torch.optim.lr_scheduler.OneCycleLR(made, rate, steps, pct_start=0.1)

    def semantic(self, steps: int) -> None:
        """Stage one: the teacher's maps, from whatever view."""
        optimiser, schedule = self.optimiser(self.args.rate, steps)
        self.head.train()
        log = StepLog("semantic")
        for number in range(steps):
            data = self.frames if number % 4 == 0 else self.photos
            rows = torch.randint(data.features.shape[1], (16,))
            maps, teacher = window(self.pick(data, rows), data.teacher[rows], 32, 40)
            with torch.autocast("cpu", torch.bfloat16):
                found = self.head.maps(maps)
            log.add(number, loss=self.step(optimiser, map_loss(found, teacher)))
            schedule.step()

    @torch.no_grad()
    def start_vlad(self) -> None:
        """Between the stages: clusters by k-means, reduction by principal components."""
        self.head.eval()
        with torch.autocast("cpu", torch.bfloat16):
            sets = [self.head.maps(d.features[v, ::k]).float() for d, v, k in self._sample_sets()]
        points = torch.cat([unit(m, 1).permute(0, 2, 3, 1).flatten(0, 2) for m in sets])
        vlad = self.head.vlad
        vlad.start_from(kmeans(points[torch.randperm(len(points))[:40000]], len(vlad.centres)))
        vectors = torch.cat([vlad.aggregate(m) for m in sets])
        mean = vectors.mean(0)
        _, strength, axes = torch.linalg.svd(vectors - mean, full_matrices=False)
        axes, strength = axes[: vlad.reduce.out_features], strength[: vlad.reduce.out_features]
        weight = axes / (strength[:, None] / strength[0]).clamp(min=0.02) ** 0.5
        vlad.reduce.weight.copy_(weight)
        vlad.reduce.bias.copy_(-weight @ mean)

    def _sample_sets(self) -> list[tuple[FeatureSet, int, int]]:
        return [(self.photos, 0, 4), (self.photos, 1, 4), (self.frames, 0, 2), (self.frames, 1, 2)]

    def place_batch(self) -> tuple[Tensor, Tensor, Tensor]:
        """Frames: anchors and partners; the masks of same and other places among them."""
        same = self.places.same
        anchors = np.random.choice(len(same), 8, replace=False)
        partners = [np.random.choice(np.flatnonzero(same[a]), 1) for a in anchors]
        rows = np.concatenate([anchors, np.concatenate(partners)])
        together = torch.from_numpy(same[np.ix_(rows, rows)]) & ~torch.eye(len(rows), dtype=torch.bool)
        return torch.from_numpy(rows), together, torch.from_numpy(self.places.other[np.ix_(rows, rows)])

    def place_terms(self) -> tuple[Tensor, Tensor]:
        """Place loss on frames and photos together, and the map loss on the photos."""
        rows, same, other = self.place_batch()
        height = REDUCTION * int(torch.randint(9, 15, ()))
        kitchen, _ = window(self.pick(self.frames, rows), None, height, height // 3 * 4)
        chosen = torch.randint(self.photos.features.shape[1], (10,))
        views = [window(self.pick(self.photos, chosen), self.photos.teacher[chosen], 24, 32) for _ in range(2)]
        with torch.autocast("cpu", torch.bfloat16):
            kitchen_maps = self.head.maps(kitchen)
            photo_maps = self.head.maps(torch.cat([v[0] for v in views]))
        vectors = torch.cat([self.head.vlad(kitchen_maps.float()), self.head.vlad(photo_maps.float())])
        twins = torch.eye(10, dtype=torch.bool).repeat(2, 2)
        all_same = torch.block_diag(same, twins).bool() & ~torch.eye(len(vectors), dtype=torch.bool)
        all_other = ~torch.block_diag(torch.ones_like(same), torch.zeros_like(twins)).bool()
        all_other[: len(rows), : len(rows)] = other
        all_other[len(rows) :, len(rows) :] = ~twins
        return place_loss(vectors, all_same, all_other), map_loss(photo_maps, torch.cat([v[1] for v in views]))

    def place(self, steps: int) -> None:
        """Stage two: the descriptor, with the normalisation statistics fixed."""
        optimiser, schedule = self.optimiser(self.args.rate / 5, steps)
        self.head.eval()
        log = StepLog("place")
        for number in range(steps):
            places, maps = self.place_terms()
            self.step(optimiser, places + 0.5 * maps)
            log.add(number, place=float(places.detach()), maps=float(maps.detach()))
            schedule.step()


class StepLog:
    """Prints means every hundred steps."""

    def __init__(self, stage: str) -> None:
        self.stage, self.rows, self.since = stage, [], time.monotonic()

    def add(self, number: int, **terms: float) -> None:
        """Counts one step."""
        self.rows.append(terms)
        if len(self.rows) == 100:
            means = {k: round(float(np.mean([r[k] for r in self.rows])), 4) for k in terms}
            print(self.stage, number + 1, means, f"{time.monotonic() - self.since:.0f} s", flush=True)
            self.rows = []


def load_data(args: argparse.Namespace, encoder: Encoder, local_step: int) -> tuple[FeatureSet, FeatureSet, Places]:
    """Feature caches of photos and of the training frames; kept in a file, as they take minutes."""
    frames = load_sequence(args.data)
    cache = args.run / f"features-{local_step}.pt"
    if cache.exists():
        saved = torch.load(cache, weights_only=True)
        return FeatureSet(*saved["photos"]), FeatureSet(*saved["frames"]), places_of(frames)
    photos = [photo_crop(p) for p in load_photos(photo_files(args.data))]
    photos = [photos[i] for i in np.linspace(0, len(photos) - 1, min(args.photos, len(photos))).astype(int)]
    greys = [f.grey for f in frames]
    made = []
    for images, variants in ((photos, args.variants), (greys, 2 * args.variants)):
        features = encoder_features(encoder, images, variants, args.seed + 1)
        made.append(FeatureSet(features, teacher_maps(images)))
        print(f"features {tuple(features.shape)}", flush=True)
    torch.save({k: (m.features, m.teacher) for k, m in zip(("photos", "frames"), made, strict=True)}, cache)
    return made[0], made[1], places_of(frames)


def start_trunk(head: GlobalHead, checkpoint: Path) -> None:
    """Takes what fits of another head, which may be deeper; clusters and reduction are found anew."""
    own, saved = head.state_dict(), torch.load(checkpoint, weights_only=True)["head"]
    fitting = {k for k in own if k in saved and not k.startswith("vlad.") and saved[k].shape == own[k].shape}
    head.load_state_dict(own | {k: saved[k].to(own[k].dtype) for k in fitting})


def save(args: argparse.Namespace, local: dict, head: GlobalHead) -> None:
    """A checkpoint of the whole network: the local part as it was, and the head."""
    state = {k: v for k, v in local.items() if k != "optimiser"}
    state |= {"head": head.state_dict(), "head_config": head.config.as_dict()}
    torch.save(state, args.run / ".last.part")
    os.replace(args.run / ".last.part", args.run / "last.pt")


def main() -> None:
    """Both stages; a head that is given skips k-means and the principal components."""
    args = arguments()
    args.run.mkdir(parents=True, exist_ok=True)
    torch.manual_seed(args.seed)
    np.random.seed(args.seed)
    torch.set_num_threads(args.threads)
    local = torch.load(args.local, weights_only=True)
    trainer = GlobalTrainer(args, *load_data(args, Encoder(local), local["step"]))
    if args.head:
        trainer.head.load_state_dict(torch.load(args.head, weights_only=True)["head"])
    elif args.trunk:
        start_trunk(trainer.head, args.trunk)
    trainer.semantic(args.semantic_steps)
    if not args.head:
        trainer.start_vlad()
    save(args, local, trainer.head)
    trainer.place(args.place_steps)
    save(args, local, trainer.head)


if __name__ == "__main__":
    main()
