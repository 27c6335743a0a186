#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The dxslam authors
"""Finds where in a saved map each of some images of a recording was taken, each by itself.

usage: find_image.py MAP RECORDING [INDEX...]
"""
import sys

import dxslam


def main(map_file, recording, *indices):
    known = dxslam.Map.load(map_file)
    source = dxslam.open_source(recording)
    for index in map(int, indices) if indices else range(len(source)):
        image = source.read(index)
        if image is None:
            continue  # a broken one: source.skipped says why
        # The camera is the recording's, which may be another than the map's.
        found = known.relocalize(image.color, image.depth, camera=source.camera)
        if found:
            x, y, z = found.world_from_camera[:3, 3]
            print(f"image {index}: at {x:.2f} {y:.2f} {z:.2f} m, confidence {found.confidence:.2f}")
        else:
            print(f"image {index}: not found")


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    try:
        main(*sys.argv[1:])
    except dxslam.InputError as error:
        sys.exit(f"find_image: {error}")
