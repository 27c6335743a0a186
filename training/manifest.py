# SPDX-License-Identifier: Apache-2.0
"""Writes the manifest of an exported model: files, hashes, and how its outputs are read.

python -m training.manifest models/hfnet --run NAME --checkpoint-step N
"""

from __future__ import annotations

import argparse
import hashlib
from pathlib import Path

import openvino as ov

from .graphs import BLOCKS, FEATURES, INPUT_STEP
from .matching import INPUT_DEVIATION_FLOOR

TEXT = """\
# Written by training/manifest.py; manifests/README.md documents the format.
format: 1
name: hfnet
description: {description}
licence: Apache-2.0 (the weights are this project's own)
files:
{files}
input:
  name: {blocks}
  channels: 1
  normalization: instance
  deviation_floor: {floor}
  unshuffle: 4
  quantization_step: {step:.9g}
  size_multiple: 32
outputs:
  keypoint_logits: {{name: keypoint_logits}}
  descriptors: {{name: descriptors}}
  features: {{name: {features}}}
global_head:
  files:
{head_files}
  input: {features}
  output: global_descriptor
global_dimension: {length}
detector:
  cell_size: 8
  score_threshold: 0.01
  nms_radius: 4
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
  training_step: {training_step}
{onnx}  data: NYU Depth v2 (colour), an ImageNet sample, Scene-15 indoor classes, 7-Scenes RedKitchen frames 0 to 598
  teachers: EdgePoint2-L64 (MIT), EfficientNet-Lite0 (Apache-2.0)
"""
ONNX = "  onnx: hfnet.onnx takes the image itself, 0 to 255, and has all outputs\n"


def file_entry(kind: str, graph: Path, indent: str) -> str:
    """YAML of one precision of a graph."""
    hashes = [hashlib.sha256(f.read_bytes()).hexdigest() for f in (graph, graph.with_suffix(".bin"))]
    lines = [f"{kind}:", f"  file: {graph.name}", f"  sha256: {hashes[0]}", f"  weights_sha256: {hashes[1]}"]
    return "\n".join(indent + line for line in lines)


def entries(folder: Path, name: str, indent: str) -> str:
    """YAML of both precisions of a graph."""
    graphs = {"float": folder / f"{name}.xml", "int8": folder / f"{name}_int8.xml"}
    return "\n".join(file_entry(kind, graph, indent) for kind, graph in graphs.items())


def length_of(graph: Path, output: str) -> int:
    """Channels of an output."""
    model = ov.Core().read_model(graph)
    return model.output(output).get_partial_shape()[1].get_length()


def manifest(folder: Path, run: str, step: int) -> str:
    """The whole text."""
    size = length_of(folder / "hfnet.xml", "descriptors")
    length = length_of(folder / "hfnet_global.xml", "global_descriptor")
    return TEXT.format(
        description=f"dxslam's own network, keypoint scores and {size}-D descriptors at 1/8 and a {length}-D "
        "global descriptor",
        files=entries(folder, "hfnet", "  "),
        head_files=entries(folder, "hfnet_global", "    "),
        blocks=BLOCKS,
        floor=INPUT_DEVIATION_FLOOR,
        step=INPUT_STEP,
        features=FEATURES,
        length=length,
        dimension=size,
        run=run,
        training_step=step,
        onnx=ONNX if (folder / "hfnet.onnx").exists() else "",
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
