# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The dxslam authors
"""The recording that the tests share: $DXSLAM_TEST_RECORDING, of `dxslam synth`, with true poses."""
import functools
import os

import numpy as np

import dxslam

PATH = os.environ.get("DXSLAM_TEST_RECORDING", "")
if not PATH:
    raise RuntimeError("DXSLAM_TEST_RECORDING is not set, expected the folder of a recording made by "
                       "`dxslam synth --frames 40`")


@functools.cache
def source():
    return dxslam.open_source(PATH)


@functools.cache
def images():
    """All of them, as arrays of NumPy's own: (stamp, colour, depth)."""
    return [(image.stamp, np.array(image.color), np.array(image.depth)) for image in source()]


@functools.cache
def extractor():
    """Quick to load, and without a network."""
    return dxslam.Extractor("orb")


@functools.cache
def network():
    return dxslam.Extractor("hfnet")


def system(**named):
    return dxslam.System(source().camera, **{"extractor": extractor()} | named)


@functools.cache
def finished():
    """A System with the network that has worked on all images, what it told, and all events."""
    told = []
    with system(extractor=network(), on_frame=told.append) as slam:
        events = slam.subscribe(capacity=100_000)
        for image in images():
            slam.process(*image)
    return slam, told, list(events)
