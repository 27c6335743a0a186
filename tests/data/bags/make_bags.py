#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The dxslam authors
"""Makes the small bags beside this file, by writers that are not ours.

usage: make_bags.py   with rosbags 0.11.9, mcap 1.6.0, lz4 and zstandard from PyPI

Every bag holds the same three frames of a camera of 16x12 pixels: colour (rgb8), depth (16UC1,
millimetres), calibration, and the transform from the depth to the colour camera. Depth is stamped 4 ms
after colour. Pixel (x, y) of frame n is (16 n + x, 20 y, 7), its depth 1000 + 100 n + 10 y + x.
"""
import shutil
import struct
from pathlib import Path

import numpy
from mcap.writer import CompressionType, Writer as McapWriter
from rosbags.rosbag1 import Writer as Ros1Writer
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer as Ros2Writer
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

HERE = Path(__file__).resolve().parent
WIDTH, HEIGHT, FRAMES = 16, 12, 3
START_NS, STEP_NS, DEPTH_NS = 1_700_000_000_000_000_000, 100_000_000, 4_000_000
COLOR, DEPTH = "/camera/color/image_raw", "/camera/depth/image_rect_raw"
INFO, DEPTH_INFO = "/camera/color/camera_info", "/camera/depth/camera_info"


def pictures(n):
    x, y = numpy.meshgrid(numpy.arange(WIDTH), numpy.arange(HEIGHT))
    color = numpy.stack([16 * n + x, 20 * y, numpy.full_like(x, 7)], axis=-1).astype(numpy.uint8)
    return color, (1000 + 100 * n + 10 * y + x).astype("<u2")


class Messages:
    """The same messages in the types of ROS 1 or ROS 2."""

    def __init__(self, store):
        self.store = get_typestore(store)
        self.ros1 = store == Stores.ROS1_NOETIC
        if self.ros1:
            self.store.register(get_types_from_msg("geometry_msgs/TransformStamped[] transforms",
                                                   "tf2_msgs/msg/TFMessage"))

    def make(self, name, *values):
        return self.store.types[name](*values)

    def header(self, ns, frame):
        stamp = self.make("builtin_interfaces/msg/Time", ns // 10**9, ns % 10**9)
        return self.make("std_msgs/msg/Header", *([0] if self.ros1 else []), stamp, frame)

    def image(self, ns, frame, encoding, pixels):
        raw = numpy.frombuffer(pixels.tobytes(), numpy.uint8)
        return self.make("sensor_msgs/msg/Image", self.header(ns, frame), HEIGHT, WIDTH, encoding, 0,
                         len(raw) // HEIGHT, raw)

    def info(self, ns, frame):
        region = self.make("sensor_msgs/msg/RegionOfInterest", 0, 0, 0, 0, False)
        k = numpy.array([20.0, 0, 7.5, 0, 21.0, 5.5, 0, 0, 1])
        d = numpy.array([0.01, -0.02, 0.001, 0.002, 0.0])
        p = numpy.array([20.0, 0, 7.5, 0, 0, 21.0, 5.5, 0, 0, 0, 1, 0])
        return self.make("sensor_msgs/msg/CameraInfo", self.header(ns, frame), HEIGHT, WIDTH,
                         "plumb_bob", d, k, numpy.eye(3).flatten(), p, 0, 0, region)

    def transforms(self, ns):
        transform = self.make("geometry_msgs/msg/Transform",
                              self.make("geometry_msgs/msg/Vector3", 0.015, 0.0, 0.0),
                              self.make("geometry_msgs/msg/Quaternion", 0.0, 0.0, 0.0, 1.0))
        stamped = self.make("geometry_msgs/msg/TransformStamped", self.header(ns, "color_frame"),
                            "depth_frame", transform)
        return self.make("tf2_msgs/msg/TFMessage", [stamped])

    def all(self):
        """(topic, type, time, message) in the order of recording."""
        yield "/tf_static", "tf2_msgs/msg/TFMessage", START_NS, self.transforms(START_NS)
        for n in range(FRAMES):
            ns = START_NS + n * STEP_NS
            color, depth = pictures(n)
            yield INFO, "sensor_msgs/msg/CameraInfo", ns, self.info(ns, "color_frame")
            yield DEPTH_INFO, "sensor_msgs/msg/CameraInfo", ns, self.info(ns, "depth_frame")
            yield (COLOR, "sensor_msgs/msg/Image", ns + 1_000_000,
                   self.image(ns, "color_frame", "rgb8", color))
            yield (DEPTH, "sensor_msgs/msg/Image", ns + 2_000_000,
                   self.image(ns + DEPTH_NS, "depth_frame", "16UC1", depth))


def add_all(writer, messages, serialize):
    connections = {}
    for topic, kind, ns, message in messages.all():
        if topic not in connections:
            connections[topic] = writer.add_connection(topic, kind, typestore=messages.store)
        writer.write(connections[topic], ns, serialize(message, kind))


def ros1(name, compression=None):
    messages = Messages(Stores.ROS1_NOETIC)
    (HERE / name).unlink(missing_ok=True)
    writer = Ros1Writer(HERE / name)
    if compression:
        writer.set_compression(compression)
    with writer:
        add_all(writer, messages, messages.store.serialize_ros1)


def ros2(name, plugin, per_message=False):
    messages = Messages(Stores.ROS2_JAZZY)
    shutil.rmtree(HERE / name, ignore_errors=True)
    writer = Ros2Writer(HERE / name, version=9, storage_plugin=plugin)
    if per_message:
        writer.set_compression(CompressionMode.MESSAGE, CompressionFormat.ZSTD)
    with writer:
        add_all(writer, messages, messages.store.serialize_cdr)


def mcap(name, compression, **options):
    messages = Messages(Stores.ROS2_JAZZY)
    with (HERE / name).open("wb") as file:
        writer = McapWriter(file, compression=compression, chunk_size=1500, **options)
        writer.start(profile="ros2", library="make_bags.py")
        channels = {}
        for topic, kind, ns, message in messages.all():
            if topic not in channels:
                schema = writer.register_schema(kind, "ros2msg", b"")
                channels[topic] = writer.register_channel(topic, "cdr", schema)
            data = bytes(messages.store.serialize_cdr(message, kind))
            assert struct.unpack_from("<H", data)[0] in (0, 256)
            writer.add_message(channels[topic], ns, data, ns)
        writer.finish()


def main():
    ros1("plain.bag")
    ros1("lz4.bag", Ros1Writer.CompressionFormat.LZ4)
    ros1("bz2.bag", Ros1Writer.CompressionFormat.BZ2)
    ros2("sqlite", StoragePlugin.SQLITE3)
    ros2("sqlite_zstd", StoragePlugin.SQLITE3, per_message=True)
    ros2("mcap", StoragePlugin.MCAP)
    mcap("zstd.mcap", CompressionType.ZSTD)
    mcap("lz4.mcap", CompressionType.LZ4)
    mcap("plain.mcap", CompressionType.NONE)
    mcap("unchunked.mcap", CompressionType.NONE, use_chunking=False)


if __name__ == "__main__":
    main()
