# SPDX-License-Identifier: Apache-2.0
"""Writes the manifest of an exported model: files, hashes, and how its outputs are read.

python -m training.manifest models/hfnet --run NAME --checkpoint-step N
"""

from __future__ import annotations

import argparse
import hashlib
from pathlib import Path

import openvino as ov

TEXT = """\
# Written by training/manifest.py; manifests/README.md documents the format.
format: 1
name: hfnet
description: {description}
licence: Apache-2.0 (the weights are this project's own)
files:
{files}
input:
  name: image
  channels: 1
  scale: 1.0  # grey 0..255; the graph normalises to zero mean and unit deviation itself
  size_multiple: 32
outputs:
{outputs}
{globals}detector:
  cell_size: 8
  score_threshold: 0.01
  nms_radius: 3
  nms_iterations: 0
  max_keypoints: 1000
  border: 8
descriptor:
  dimension: {dimension}
  stride: 8
  align_corners: false
  max_distance: 0.9
info:
  training_run: {run}
  training_step: {step}
  data: NYU Depth v2 (colour), an ImageNet sample, Scene-15 indoor classes, 7-Scenes RedKitchen frames 0 to 598
  teachers: EdgePoint2-L64 (MIT){global_teacher}
"""
OUTPUTS = {
    "keypoint_logits": "keypoint_logits: {name: keypoint_logits}",
    "descriptors": "descriptors: {name: descriptors}",
    "global_descriptor": "global: {name: global_descriptor}",
}


def file_entry(kind: str, graph: Path) -> str:
    """YAML of one precision of the model."""
    hashes = [hashlib.sha256(f.read_bytes()).hexdigest() for f in (graph, graph.with_suffix(".bin"))]
    lines = [f"  {kind}:", f"    file: {graph.name}", f"    sha256: {hashes[0]}", f"    weights_sha256: {hashes[1]}"]
    return "\n".join(lines)


def manifest(folder: Path, run: str, step: int) -> str:
    """The whole text."""
    graphs = {"float": folder / "hfnet.xml", "int8": folder / "hfnet_int8.xml"}
    model = ov.Core().read_model(graphs["float"])
    shapes = {o.any_name: o.get_partial_shape() for o in model.outputs}
    has_global = "global_descriptor" in shapes
    length = shapes["global_descriptor"][1].get_length() if has_global else 0
    size = shapes["descriptors"][1].get_length()
    extra = f" and a {length}-D global descriptor" if has_global else ""
    return TEXT.format(
        description=f"dxslam's own network, keypoint scores and {size}-D descriptors at 1/8{extra}",
        files="\n".join(file_entry(kind, graph) for kind, graph in graphs.items() if graph.exists()),
        outputs="\n".join("  " + OUTPUTS[name] for name in shapes),
        globals=f"global_dimension: {length}\n" if has_global else "",
        dimension=size,
        run=run,
        step=step,
        global_teacher=", EfficientNet-Lite0 (Apache-2.0)" if has_global else "",
    )


def main() -> None:
    """Command line."""
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("folder", type=Path)
    p.add_argument("--run", required=True)
    p.add_argument("--checkpoint-step", type=int, required=True)
    a = p.parse_args()
    (a.folder / "manifest.yaml").write_text(manifest(a.folder, a.run, a.checkpoint_step))


if __name__ == "__main__":
    main()
