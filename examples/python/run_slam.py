#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The dxslam authors
"""Runs SLAM on a recording (a folder or a bag), writes the trajectory, and the map if asked to.

usage: run_slam.py RECORDING TRAJECTORY [MAP]
"""
import sys

import dxslam


def main(recording, trajectory, map_file=None):
    source = dxslam.open_source(recording)
    for note in source.notes:  # what was guessed
        print(f"note: {note}", file=sys.stderr)

    with dxslam.System(source.camera) as slam:
        # Your own camera goes here: slam.process(stamp, color, depth) with NumPy arrays.
        for image in source:
            slam.process(image)

    poses = slam.trajectory()
    poses.write(trajectory)
    print(f"{len(poses)} of {len(slam.frames())} images tracked")
    if len(source.ground_truth):
        error = dxslam.evaluate.ate(source.ground_truth, poses).position
        print(f"absolute trajectory error {100 * error.rmse:.1f} cm")
    if map_file:
        slam.map().save(map_file)


if __name__ == "__main__":
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__)
    try:
        main(*sys.argv[1:])
    except dxslam.InputError as error:  # one sentence: what, where, what was expected
        sys.exit(f"run_slam: {error}")
