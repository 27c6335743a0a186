# SPDX-License-Identifier: Apache-2.0
"""The exported graph cut into what is run: a local part and a global head, joined by 8-bit integers once quantised.

The local part begins behind normalisation and space-to-depth, which the caller does quicker; the head begins at the
encoder's features, so that it may run later, or never.
"""

from __future__ import annotations

import numpy as np
import openvino as ov
from openvino import opset13 as ops

INPUT_RANGE = 6.0  # deviations of the normalised image; what is brighter saturates
INPUT_STEP = INPUT_RANGE / 127
BLOCKS, FEATURES = "blocks", "features"
LEVELS = 256
TO_LAST = [0, 2, 3, 1]
FROM_LAST = [0, 3, 1, 2]


def replace_output(old: ov.Output, new: ov.Output, kept: tuple[ov.Node, ...] = ()) -> None:
    """Feeds all that reads `old`, but `kept`, from `new`."""
    for port in old.get_target_inputs():
        if port.get_node() not in kept:
            port.replace_source_output(new)


def new_parameter(shape: list[int], kind: type, name: str) -> ov.op.Parameter:
    """An input with a name."""
    made = ops.parameter(ov.PartialShape(shape), kind, name=name)
    made.output(0).set_names({name})
    return made


def find_output(model: ov.Model, name: str) -> ov.Output:
    """What an output of the model gives."""
    return next(r.input_value(0) for r in model.get_results() if name in r.output(0).get_names())


def cut_local(whole: ov.Model) -> ov.Model:
    """Normalised blocks [1,16,h,w] to keypoint logits, descriptors and, if there is a head, features."""
    whole = whole.clone()
    shuffle = next(n for n in whole.get_ordered_ops() if n.get_type_name() == "SpaceToDepth")
    blocks = new_parameter([1, 16, -1, -1], np.float32, BLOCKS)
    replace_output(shuffle.output(0), blocks.output(0))
    names = ["keypoint_logits", "descriptors", FEATURES]
    results = [r for n in names for r in whole.get_results() if n in r.output(0).get_names()]
    return ov.Model(results, [blocks], "hfnet")


def cut_head(whole: ov.Model) -> ov.Model:
    """Features [1,64,h,w] to the global descriptor."""
    whole = whole.clone()
    found = find_output(whole, FEATURES)
    channels = found.get_partial_shape()[1].get_length()
    features = new_parameter([1, channels, -1, -1], np.float32, FEATURES)
    found.set_names(set())
    replace_output(found, features.output(0))
    results = [r for r in whole.get_results() if "global_descriptor" in r.output(0).get_names()]
    return ov.Model(results, [features], "hfnet_global")


def quantiser(source: ov.Output, bottom: float, top: float, low: float, high: float) -> ov.Node:
    """Rounds to 256 levels from bottom to top, which become low to high."""
    bounds = [ops.constant(np.full((1, 1, 1, 1), b, np.float32)) for b in (bottom, top, low, high)]
    return ops.fake_quantize(source, *bounds, LEVELS)


def integer_input(local: ov.Model) -> None:
    """In place: the input becomes signed 8-bit integers of INPUT_STEP, which the first convolution reads as they are."""
    old = local.get_parameters()[0]
    blocks = new_parameter([1, 16, -1, -1], np.int8, BLOCKS)
    values = ops.multiply(ops.convert(blocks, "f32"), ops.constant(np.float32(INPUT_STEP)))
    rounded = quantiser(values.output(0), -INPUT_STEP * 128, INPUT_RANGE, -INPUT_STEP * 128, INPUT_RANGE)
    for port in old.output(0).get_target_inputs():
        first = port.get_node()
        replaced = first.output(0) if first.get_type_name() == "FakeQuantize" else old.output(0)
        replace_output(replaced, rounded.output(0))
    local.add_parameters([blocks])
    local.remove_parameter(old)
    local.validate_nodes_and_infer_types()


def feature_quantisers(local: ov.Model) -> list[ov.Node]:
    """What rounds the features, for each of their readers alike; from 0, as they follow a ReLU."""
    readers = [p.get_node() for p in find_output(local, FEATURES).get_target_inputs()]
    found = [n for n in readers if n.get_type_name() == "FakeQuantize"]
    if not found or any(float(np.min(n.input_value(1).get_node().get_data())) != 0 for n in found):
        raise SystemExit("the features are not quantised from 0")
    return found


def feature_range(local: ov.Model) -> float:
    """The top of the quantised features."""
    return max(float(np.max(n.input_value(2).get_node().get_data())) for n in feature_quantisers(local))


def integer_features(local: ov.Model) -> None:
    """In place: the features leave as 8-bit integers, as the convolutions hand them on, channels last."""
    top = feature_range(local)
    old = feature_quantisers(local)
    result = next(r for r in local.get_results() if FEATURES in r.output(0).get_names())
    find_output(local, FEATURES).set_names(set())
    integers = ops.convert(quantiser(old[0].input_value(0), 0, top, 0, LEVELS - 1), "u8")
    values = ops.multiply(ops.convert(integers, "f32"), ops.constant(np.float32(top / (LEVELS - 1))))
    for node in old:
        replace_output(node.output(0), values.output(0))
    local.remove_result(result)
    out = ops.result(ops.transpose(integers, ops.constant(np.array(TO_LAST))))
    out.output(0).get_tensor().set_names({FEATURES})
    out.input_value(0).set_names({FEATURES})
    local.add_results([out])
    local.validate_nodes_and_infer_types()


def float_features(local: ov.Model) -> None:
    """In place: the features leave as floats, channels last."""
    result = next(r for r in local.get_results() if FEATURES in r.output(0).get_names())
    found = result.input_value(0)
    found.set_names(set())
    local.remove_result(result)
    out = ops.result(ops.transpose(found, ops.constant(np.array(TO_LAST))))
    out.input_value(0).set_names({FEATURES})
    local.add_results([out])
    local.validate_nodes_and_infer_types()


def head_input(head: ov.Model, top: float | None) -> None:
    """In place: features come channels last; as the integers that integer_features() makes if their range is given."""
    old = head.get_parameters()[0]
    channels = old.output(0).get_partial_shape()[1].get_length()
    features = new_parameter([1, -1, -1, channels], np.float32 if top is None else np.uint8, FEATURES)
    values = ops.transpose(features, ops.constant(np.array(FROM_LAST))).output(0)
    replaced = old.output(0)
    if top is not None:
        step = np.float32(top / (LEVELS - 1))
        values = ops.multiply(ops.convert(values, "f32"), ops.constant(step)).output(0)
        readers = [p.get_node() for p in replaced.get_target_inputs()]
        if len(readers) == 1 and readers[0].get_type_name() == "FakeQuantize":
            replaced = readers[0].output(0)
        values = quantiser(values, 0, top, 0, top).output(0)
    replace_output(replaced, values)
    head.add_parameters([features])
    head.remove_parameter(old)
    head.validate_nodes_and_infer_types()
