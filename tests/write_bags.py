#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The dxslam authors
"""Writes one recording of `dxslam synth` as a folder of PNG images and as bags of every kind.

usage: write_bags.py SYNTH OUT   with rosbags, mcap, numpy and Pillow (.venvs/eval)
"""
import io
import struct
import sys
from pathlib import Path

import numpy
from mcap.writer import CompressionType, Writer as McapWriter
from PIL import Image
from rosbags.rosbag1 import Writer as Ros1Writer
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer as Ros2Writer
from rosbags.typesys import Stores, get_typestore

COLOR, DEPTH, INFO = "/camera/color/image_raw", "/camera/depth/image_raw", "/camera/color/camera_info"
FRAME = "camera_color_optical_frame"
FIELDS = ("width", "height", "fx", "fy", "cx", "cy", "fps", "depth_factor")
START = 1_700_000_000 * 10**9  # a clock of today
METRES = numpy.float32(0.001)  # rounded as every reader of 16-bit depth rounds


def png(pixels):
    file = io.BytesIO()
    Image.fromarray(pixels).save(file, "PNG", compress_level=1)
    return file.getvalue()


class Recording:
    """Frames of a TUM folder: (nanoseconds, colour RGB, depth in millimetres)."""

    def __init__(self, folder):
        self.camera = {}
        for line in (folder / "calibration.yaml").read_text().splitlines():
            key, _, value = line.split("#")[0].partition(":")
            if key.strip() in FIELDS:
                self.camera[key.strip()] = float(value)
        lists = [[line.split() for line in (folder / name).read_text().splitlines()
                  if line and line[0] != "#"] for name in ("rgb.txt", "depth.txt")]
        scale = 1000.0 / self.camera["depth_factor"]
        self.frames = []
        for (stamp, color), (_, depth) in zip(*lists):
            raw = numpy.asarray(Image.open(folder / depth)).astype(numpy.float64)
            self.frames.append((START + round(float(stamp) * 1e6) * 1000,
                                numpy.asarray(Image.open(folder / color).convert("RGB")),
                                numpy.round(raw * scale).astype(numpy.uint16)))

    def write_folder(self, out):
        (out / "rgb").mkdir(parents=True)
        (out / "depth").mkdir()
        lists = {"rgb": [], "depth": []}
        for ns, color, depth in self.frames:
            for name, pixels in (("rgb", color), ("depth", depth)):
                (out / name / f"{ns}.png").write_bytes(png(pixels))
                lists[name].append(f"{ns // 10**9}.{ns // 1000 % 10**6:06d} {name}/{ns}.png")
        for name, lines in lists.items():
            (out / f"{name}.txt").write_text("\n".join(lines) + "\n")
        camera = {**self.camera, "depth_factor": 1000.0}
        (out / "calibration.yaml").write_text(
            "".join(f"{key}: {value:g}\n" for key, value in camera.items()))


class Messages:
    def __init__(self, store):
        self.store = get_typestore(store)
        self.ros1 = store == Stores.ROS1_NOETIC
        self.serialize = self.store.serialize_ros1 if self.ros1 else self.store.serialize_cdr

    def make(self, name, *values):
        return self.store.types[name](*values)

    def header(self, ns):
        stamp = self.make("builtin_interfaces/msg/Time", ns // 10**9, ns % 10**9)
        return self.make("std_msgs/msg/Header", *([0] if self.ros1 else []), stamp, FRAME)

    def image(self, ns, encoding, pixels):
        raw = numpy.frombuffer(pixels.tobytes(), numpy.uint8)
        return self.make("sensor_msgs/msg/Image", self.header(ns), *pixels.shape[:2], encoding, 0,
                         len(raw) // pixels.shape[0], raw)

    def compressed(self, ns, form, data):
        return self.make("sensor_msgs/msg/CompressedImage", self.header(ns), form,
                         numpy.frombuffer(data, numpy.uint8))

    def info(self, ns, camera):
        k = [camera["fx"], 0, camera["cx"], 0, camera["fy"], camera["cy"], 0, 0, 1]
        region = self.make("sensor_msgs/msg/RegionOfInterest", 0, 0, 0, 0, False)
        return self.make("sensor_msgs/msg/CameraInfo", self.header(ns), int(camera["height"]),
                         int(camera["width"]), "plumb_bob", numpy.zeros(5), numpy.array(k, float),
                         numpy.eye(3).flatten(), numpy.zeros(12), 0, 0, region)

    def of(self, recording, style="raw"):
        """(topic, type, time, message) in the order of recording."""
        image, packed = "sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage"
        for ns, color, depth in recording.frames:
            yield INFO, "sensor_msgs/msg/CameraInfo", ns, self.info(ns, recording.camera)
            if style == "compressed":
                yield (COLOR + "/compressed", packed, ns,
                       self.compressed(ns, "rgb8; png compressed bgr8", png(color)))
                yield (DEPTH + "/compressedDepth", packed, ns,
                       self.compressed(ns, "16UC1; compressedDepth png",
                                       struct.pack("<iff", 0, 0, 0) + png(depth)))
            elif style == "float":
                yield COLOR, image, ns, self.image(ns, "bgr8", color[:, :, ::-1])
                yield DEPTH, image, ns, self.image(ns, "32FC1", depth.astype("<f4") * METRES)
            else:
                yield COLOR, image, ns, self.image(ns, "rgb8", color)
                yield DEPTH, image, ns, self.image(ns, "16UC1", depth.astype("<u2"))


def rosbag(writer, messages, recording, style="raw"):
    connections = {}
    with writer:
        for topic, kind, ns, message in messages.of(recording, style):
            if topic not in connections:
                connections[topic] = writer.add_connection(topic, kind, typestore=messages.store)
            writer.write(connections[topic], ns, messages.serialize(message, kind))


def ros1(path, recording, compression=None, style="raw"):
    writer = Ros1Writer(path)
    if compression:
        writer.set_compression(compression)
    rosbag(writer, Messages(Stores.ROS1_NOETIC), recording, style)


def ros2(path, recording, plugin, per_message=False):
    writer = Ros2Writer(path, version=9, storage_plugin=plugin)
    if per_message:
        writer.set_compression(CompressionMode.MESSAGE, CompressionFormat.ZSTD)
    rosbag(writer, Messages(Stores.ROS2_JAZZY), recording)


def mcap(path, recording, compression, style="raw", cameras=("/camera",)):
    messages = Messages(Stores.ROS2_JAZZY)
    with path.open("wb") as file:
        writer = McapWriter(file, compression=compression)
        writer.start(profile="ros2", library="write_bags.py")
        channels = {}
        for topic, kind, ns, message in messages.of(recording, style):
            for camera in cameras:
                name = topic.replace("/camera", camera, 1)
                if name not in channels:
                    schema = writer.register_schema(kind, "ros2msg", b"")
                    channels[name] = writer.register_channel(name, "cdr", schema)
                writer.add_message(channels[name], ns, bytes(messages.serialize(message, kind)), ns)
        writer.finish()


def main():
    source, out = map(Path, sys.argv[1:])
    recording = Recording(source)
    recording.write_folder(out / "folder")
    ros1(out / "bag_plain.bag", recording)
    ros1(out / "bag_lz4.bag", recording, Ros1Writer.CompressionFormat.LZ4)
    ros1(out / "bag_bz2.bag", recording, Ros1Writer.CompressionFormat.BZ2)
    ros1(out / "bag_compressed.bag", recording, style="compressed")
    ros2(out / "bag_sqlite", recording, StoragePlugin.SQLITE3)
    ros2(out / "bag_sqlite_zstd", recording, StoragePlugin.SQLITE3, per_message=True)
    ros2(out / "bag_mcap", recording, StoragePlugin.MCAP)
    mcap(out / "bag_zstd.mcap", recording, CompressionType.ZSTD)
    mcap(out / "bag_lz4.mcap", recording, CompressionType.LZ4)
    mcap(out / "bag_float.mcap", recording, CompressionType.NONE, style="float")
    mcap(out / "bag_packed.mcap", recording, CompressionType.NONE, style="compressed")
    mcap(out / "bag_two_cameras.mcap", recording, CompressionType.ZSTD,
         cameras=("/back", "/front"))


if __name__ == "__main__":
    main()
