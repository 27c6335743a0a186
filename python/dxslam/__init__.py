# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The dxslam authors
"""Robust and efficient visual SLAM with deep features.

    import dxslam

    camera = dxslam.Camera.load("my_camera.yaml")
    with dxslam.System(camera) as slam:
        for stamp, color, depth in my_camera():  # NumPy: uint8 BGR, float32 metres
            slam.process(stamp, color, depth)
    slam.trajectory().write("trajectory.txt")

Poses are `world_from_camera`, 4 x 4, metres: x right, y down, z forward. docs/python.md shows more.
"""
from pathlib import Path as _Path

try:
    from . import _dxslam
except ImportError as _error:
    from ._openvino import load_elsewhere as _load_elsewhere
    _load_elsewhere(_error)
    from . import _dxslam
from . import evaluate
from ._dxslam import (
    AllPoses, AteReport, Camera, ComponentSummary, ContractError, Error, ErrorStatistics, Event,
    Extractor, Features, Frames, FrameTracked, Image, ImageSkipped, InputError, Keyframe, KeyframeMapped,
    KeyframePoses, LoopClosed, LoopFound, LoopRefused, LossReason, Map, MapChanged, MappingReport,
    MapSaved, MapsJoined, PlaceFound, PointPositions, RecordingBegun, RecordingEnded, Relocalization,
    RpeReport, RunFailed, RunFinished, SkipReason, Source, SourceIterator, StageSummary, Subscription,
    System, TrackedFrame, TrackingLost, TrackingState, Trajectory, __version__, available_extractors,
    data_directory, match, open_source, source_formats)
from .options import Options

__all__ = [name for name in globals() if not name.startswith("_") and name != "options"]

for _name in __all__:  # where users find them
    if isinstance(globals()[_name], type):
        globals()[_name].__module__ = __name__

_data = _Path(__file__).parent / "data"
if _data.is_dir():
    _dxslam.set_data_directory(str(_data))
