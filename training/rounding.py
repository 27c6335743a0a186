# SPDX-License-Identifier: Apache-2.0
"""Rounds the 8-bit weights of convolutions for what they read, not each to the nearest (GPTQ, arXiv:2210.17323).

The inputs of a convolution are alike, those of the first almost equal (neighbouring pixels), so errors of weights rounded one by one
add up. Here each weight's error is carried over to the weights not yet rounded, so that the outputs change least.
"""

from __future__ import annotations

import numpy as np
import openvino as ov
from numpy.typing import NDArray
from openvino import opset13 as ops

from .inference import compile_on_cpu

Array = NDArray[np.float64]
TOP = 127
DAMPING = 1e-3  # share of the mean second moment; as if inputs had independent noise
SAMPLES = 1500  # positions an image


def round_rows(weights: Array, moments: Array) -> Array:
    """Integers q near `weights` (rows, inputs), such that (weights - q) @ moments @ (weights - q).T stays small."""
    count = len(moments)
    order = np.argsort(-np.diag(moments), kind="stable")  # the weightiest first, while there are others to carry errors to
    damped = moments[np.ix_(order, order)] + DAMPING * np.mean(np.diag(moments)) * np.eye(count)
    spread = np.linalg.cholesky(np.linalg.inv(damped)).T
    left = weights[:, order].astype(np.float64)
    rounded = np.zeros_like(left)
    for k in range(count):
        rounded[:, k] = np.clip(np.rint(left[:, k]), -TOP, TOP)
        error = (left[:, k] - rounded[:, k]) / spread[k, k]
        left[:, k + 1 :] -= error[:, None] * spread[k, k + 1 :][None]
    return rounded[:, np.argsort(order)]


def patches(image: NDArray, size: int) -> NDArray:
    """What a convolution of size x size reads at each position of (C,H,W): (H*W, C*size*size)."""
    reach = size // 2
    padded = np.pad(image, ((0, 0), (reach, reach), (reach, reach)))
    windows = np.lib.stride_tricks.sliding_window_view(padded, (size, size), axis=(1, 2))
    return windows.transpose(1, 2, 0, 3, 4).reshape(-1, image.shape[0] * size * size)


def convolutions(model: ov.Model) -> dict[str, ov.Node]:
    """By name, in the order of computation."""
    return {n.get_friendly_name(): n for n in model.get_ordered_ops() if n.get_type_name() == "Convolution"}


def second_moments(model: ov.Model, convolution: ov.Node, inputs: list[NDArray]) -> Array:
    """Of what the convolution reads, over random positions of the inputs."""
    size = convolution.input_value(1).get_partial_shape()[2].get_length()
    cut = ov.Model([ops.result(convolution.input_value(0))], model.get_parameters(), "cut")
    run = compile_on_cpu(cut)
    rng = np.random.default_rng(0)
    total = 0.0
    for image in inputs:
        read = patches(np.array(run([image])[0])[0], size)
        read = read[rng.integers(0, len(read), SAMPLES)]
        total = total + (read.T @ read).astype(np.float64)
    return total / (SAMPLES * len(inputs))


def round_weights(small: ov.Model, whole: ov.Model, inputs: list[NDArray]) -> None:
    """In place: new integers for the convolutions of `small`, which NNCF made of `whole`; one after another, so that each is fitted to
    what the ones before it give. Their scales stay."""
    exact = convolutions(whole)
    for name, convolution in convolutions(small).items():
        scaled = convolution.input_value(1).get_node()
        if scaled.get_type_name() != "Multiply":
            continue  # left in floating point
        scale = scaled.input_value(1).get_node().get_data().astype(np.float64)
        weights = exact[name].input_value(1).get_node().get_data() / scale
        moments = second_moments(small, convolution, inputs)
        integers = round_rows(weights.reshape(len(weights), -1), moments).reshape(weights.shape)
        stored = ops.convert(ops.constant(integers.astype(np.int8)), "f32")
        scaled.input(0).replace_source_output(stored.output(0))
    small.validate_nodes_and_infer_types()
