#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The dxslam authors
"""Tells what happens inside while a recording is worked on: events, read in a thread of their own.

usage: watch.py RECORDING
"""
import sys
import threading

import dxslam


def watch(events):
    """A thread that is too slow loses old events, and never holds up tracking."""
    tracked = 0
    positions: dict[int, object] = {}  # of the map's points, by id
    for event in events:  # ends with slam.finish()
        match event:
            case dxslam.FrameTracked(frame=frame):
                tracked += frame.state == dxslam.TrackingState.TRACKING
            case dxslam.MapChanged():
                for points in (event.added_points, event.moved_points):
                    positions.update(zip(points.ids.tolist(), points.positions))
                for point in event.removed_points.tolist():
                    positions.pop(point, None)
                if event.is_correction:
                    print("the map was corrected: poses given before are not right any more")
            case dxslam.TrackingLost(reason=reason, stamp=stamp):
                print(f"lost at {stamp:.3f} s: {reason.name}")
            case dxslam.LoopClosed() | dxslam.MapsJoined():
                print(f"loop closed: keyframe {event.query} sees what {event.candidate} saw")
    print(f"{tracked} images tracked, {len(positions)} points, {events.lost} events missed")


def main(recording):
    source = dxslam.open_source(recording)
    with dxslam.System(source.camera) as slam:
        thread = threading.Thread(target=watch, args=[slam.subscribe()])
        thread.start()
        for image in source:
            slam.process(image)
    thread.join()


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    try:
        main(sys.argv[1])
    except dxslam.InputError as error:
        sys.exit(f"watch: {error}")
