# SPDX-License-Identifier: Apache-2.0
"""Trains the local part by distillation; resumable.

python -m training.train --data DIR --teacher FILE --run DIR --steps N [--decay-steps M] [--resume FILE]
"""

from __future__ import annotations

import argparse
import csv
import json
import os
import signal
import time
from pathlib import Path

import numpy as np
import torch
from torch import Tensor, nn

from .data import load_photos, load_sequence, photo_files
from .losses import LossOptions, local_losses, total
from .network import LocalNet, NetworkConfig
from .samples import SampleOptions, SampleStream, SampleWorker

LOG_EVERY, SAVE_EVERY = 50, 500


def arguments() -> argparse.Namespace:
    """Command line."""
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("--data", type=Path, required=True, help="folder with train/ and 7scenes_redkitchen/")
    p.add_argument("--teacher", type=Path, required=True, help="EdgePoint2 ONNX file")
    p.add_argument("--run", type=Path, required=True, help="folder of checkpoints and curves")
    p.add_argument("--steps", type=int, default=20000)
    p.add_argument("--decay-steps", type=int, default=4000, help="last steps, over which the rate falls to zero")
    p.add_argument("--rate", type=float, default=2e-3)
    p.add_argument("--pairs", type=int, default=8, help="pairs of crops a step")
    p.add_argument("--workers", type=int, default=2)
    p.add_argument("--threads", type=int, default=2)
    p.add_argument("--seed", type=int, default=0)
    p.add_argument("--resume", type=Path, help="checkpoint; the default is the run's own last one")
    return p.parse_args()


def learning_rate(step: int, peak: float, steps: int, decay: int) -> float:
    """Warm-up, plateau, linear decay: a plateau can be prolonged, or ended early, when resuming."""
    warm = min(1.0, (step + 1) / 200)
    return peak * warm * min(1.0, max(0.0, (steps - step) / max(decay, 1)))


class Ema:
    """Running mean of weights and of normalisation statistics."""

    def __init__(self, model: nn.Module, decay: float = 0.999) -> None:
        self.decay = decay
        self.state = {k: v.detach().clone() for k, v in model.state_dict().items()}

    @torch.no_grad()
    def update(self, model: nn.Module, step: int) -> None:
        """Moves towards the model; faster in the first steps."""
        decay = min(self.decay, (1 + step) / (10 + step))
        for name, value in model.state_dict().items():
            if value.is_floating_point():
                self.state[name].lerp_(value, 1 - decay)
            else:
                self.state[name].copy_(value)


class Trainer:
    """Model, optimiser, running mean and the log of one run."""

    def __init__(self, args: argparse.Namespace) -> None:
        self.args, self.step = args, 0
        args.run.mkdir(parents=True, exist_ok=True)
        resume = args.resume or args.run / "last.pt"
        saved = torch.load(resume, weights_only=True) if resume.exists() else None
        config = NetworkConfig(**saved["network"]) if saved else NetworkConfig()
        self.model = LocalNet(config).to(memory_format=torch.channels_last)
        self.optimiser = torch.optim.AdamW(self.model.parameters(), lr=args.rate, weight_decay=1e-4)
        self.ema, self.losses = Ema(self.model), LossOptions()
        if saved:
            self._restore(saved)

    def _restore(self, saved: dict) -> None:
        self.model.load_state_dict(saved.get("model", saved["ema"]))
        self.ema.state = {k: v.float() if v.is_floating_point() else v for k, v in saved["ema"].items()}
        self.step = saved["step"]
        if "optimiser" in saved:
            self.optimiser.load_state_dict(saved["optimiser"])

    def save(self, name: str = "last.pt") -> None:
        """Writes a checkpoint, whole or not at all."""
        state = {"model": self.model.state_dict(), "ema": self.ema.state, "step": self.step}
        state |= {"optimiser": self.optimiser.state_dict(), "network": self.model.config.as_dict()}
        partial = self.args.run / f".{name}.part"
        torch.save(state, partial)
        os.replace(partial, self.args.run / name)

    def update(self, batch: dict[str, Tensor]) -> dict[str, float]:
        """One step of the optimiser; the values of the loss terms."""
        a = self.args
        for group in self.optimiser.param_groups:
            group["lr"] = learning_rate(self.step, a.rate, a.steps, a.decay_steps)
        images = batch["image"].flatten(0, 1)[:, None].float().contiguous(memory_format=torch.channels_last)
        with torch.autocast("cpu", torch.bfloat16):
            logits, maps, _ = self.model(images)
        terms = local_losses(logits, maps, batch, self.losses)
        self.optimiser.zero_grad()
        total(terms, self.losses).backward()
        nn.utils.clip_grad_norm_(self.model.parameters(), 5.0)
        self.optimiser.step()
        self.step += 1
        self.ema.update(self.model, self.step)
        return {name: float(value.detach()) for name, value in terms.items()}


class CurveLog:
    """Means of the loss terms, a CSV row every few steps."""

    def __init__(self, path: Path, pairs: int) -> None:
        self.path, self.pairs, self.sums, self.count = path, pairs, {}, 0
        self.since = time.monotonic()

    def add(self, step: int, rate: float, terms: dict[str, float]) -> None:
        """Counts one step; writes a row when it is time."""
        for name, value in terms.items():
            self.sums[name] = self.sums.get(name, 0.0) + value
        self.count += 1
        if step % LOG_EVERY:
            return
        now = time.monotonic()
        row = {"step": step, "crops": step * self.pairs * 2, "rate": round(rate, 6)}
        row |= {name: round(value / self.count, 4) for name, value in self.sums.items()}
        row["crops_per_s"] = round(self.count * self.pairs * 2 / (now - self.since), 1)
        fresh = not self.path.exists()
        with self.path.open("a", newline="") as file:
            writer = csv.DictWriter(file, list(row))
            if fresh:
                writer.writeheader()
            writer.writerow(row)
        print(row, flush=True)
        self.sums, self.count, self.since = {}, 0, now


def record(args: argparse.Namespace, photos: int, frames: int) -> None:
    """Writes what the run was started with."""
    listed = [str(f.relative_to(args.data)) for f in photo_files(args.data)]
    (args.run / "data.txt").write_text("\n".join(listed) + "\n")
    # Paths depend on the machine; their last part is what matters.
    options = {k: v.name if isinstance(v, Path) else v for k, v in vars(args).items()}
    options |= {"photos": photos, "sequence_frames": frames, "torch": torch.__version__}
    with (args.run / "starts.jsonl").open("a") as file:
        file.write(json.dumps(options) + "\n")


def main() -> None:
    """Runs until the steps are done, or until asked to stop."""
    args = arguments()
    if not args.teacher.is_file():
        raise SystemExit(f"--teacher {args.teacher}: no such file")
    photos, frames = load_photos(photo_files(args.data)), load_sequence(args.data)
    worker = SampleWorker(photos, frames, args.teacher, SampleOptions(seed=args.seed))
    torch.manual_seed(args.seed)
    trainer = Trainer(args)
    stream = SampleStream(worker, args.workers, trainer.step)  # forks before torch starts its threads
    torch.set_num_threads(args.threads)
    record(args, len(photos), len(frames))
    stop = []
    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, lambda *_: stop.append(True))
    log = CurveLog(args.run / "curves.csv", args.pairs)
    trainer.model.train()
    while trainer.step < args.steps and not stop:
        batch = {k: torch.from_numpy(v) for k, v in stream.batch(args.pairs).items()}
        terms = trainer.update(batch)
        log.add(trainer.step, trainer.optimiser.param_groups[0]["lr"], terms)
        if not np.isfinite(sum(terms.values())):
            raise SystemExit(f"the loss is not finite at step {trainer.step}")
        if trainer.step % SAVE_EVERY == 0:
            trainer.save()
    stream.close()
    trainer.save()


if __name__ == "__main__":
    main()
