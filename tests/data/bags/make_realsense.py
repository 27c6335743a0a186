#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The dxslam authors
"""Writes a recording of librealsense from a software device: colour 64x48 and depth 48x36, each of
three frames, not registered.

usage: make_realsense.py OUT   realsense.bag was written with pyrealsense2 2.56.5.9235, realsense.db3
with 2.59.1.11053 (PyPI, Apache-2.0; no part of our environments, as only these two files are from it)
"""
import sys
import time

import numpy
import pyrealsense2 as rs

WIDTH, HEIGHT, DEPTH_WIDTH, DEPTH_HEIGHT = 64, 48, 48, 36
ANGLE = 0.1  # of depth to colour, about z
UNIT = 0.0005


def video_stream(stream, uid, width, height, form, bytes_per_pixel, f, model, coefficients):
    made = rs.video_stream()
    made.type, made.index, made.uid = stream, 0, uid
    made.width, made.height, made.fps, made.bpp, made.fmt = width, height, 30, bytes_per_pixel, form
    lens = rs.intrinsics()
    lens.width, lens.height, lens.fx, lens.fy = width, height, f, f + 1
    lens.ppx, lens.ppy, lens.model, lens.coeffs = width / 2 - 1, height / 2 - 2, model, coefficients
    made.intrinsics = lens
    return made


def send(sensor, profile, n, milliseconds, pixels):
    frame = rs.software_video_frame()
    frame.bpp = pixels.itemsize * (pixels.shape[2] if pixels.ndim == 3 else 1)
    frame.stride = pixels.shape[1] * frame.bpp
    frame.timestamp, frame.domain = milliseconds, rs.timestamp_domain.system_time
    frame.frame_number, frame.profile = n, profile.as_video_stream_profile()
    if pixels.ndim == 2:
        frame.depth_units = UNIT
    frame.pixels = pixels
    sensor.on_video_frame(frame)


def main():
    device = rs.software_device()
    depth, color = device.add_sensor("Stereo Module"), device.add_sensor("RGB Camera")
    of_depth = depth.add_video_stream(video_stream(
        rs.stream.depth, 1, DEPTH_WIDTH, DEPTH_HEIGHT, rs.format.z16, 2, 40.0,
        rs.distortion.brown_conrady, [0] * 5))
    of_color = color.add_video_stream(video_stream(
        rs.stream.color, 2, WIDTH, HEIGHT, rs.format.rgb8, 3, 60.0,
        rs.distortion.inverse_brown_conrady, [0.05, -0.02, 0.001, 0.002, 0.003]))
    place = rs.extrinsics()  # color_from_depth, column by column
    c, s = numpy.cos(ANGLE), numpy.sin(ANGLE)
    place.rotation = [c, s, 0, -s, c, 0, 0, 0, 1]
    place.translation = [0.05, 0.01, 0.002]
    of_depth.register_extrinsics_to(of_color, place)
    depth.add_read_only_option(rs.option.depth_units, UNIT)
    device.create_matcher(rs.matchers.default)
    recorder = rs.recorder(sys.argv[1], device)
    sensors, queues = recorder.query_sensors(), []
    for sensor in sensors:
        queues.append(rs.frame_queue(50, keep_frames=True))
        sensor.open(sensor.get_stream_profiles()[0])
        sensor.start(queues[-1])
    for n in range(3):
        y, x = numpy.mgrid[0:DEPTH_HEIGHT, 0:DEPTH_WIDTH]
        send(depth, of_depth, n, 1.7e12 + n * 33.4, (2000 + 100 * n + y + x).astype(numpy.uint16))
        y, x = numpy.mgrid[0:HEIGHT, 0:WIDTH]
        send(color, of_color, n, 1.7e12 + n * 33.4 + 2,
             numpy.stack([16 * n + x, 4 * y, 0 * x + 7], -1).astype(numpy.uint8))
        time.sleep(0.05)
    time.sleep(0.3)
    for sensor in sensors:
        sensor.stop()
        sensor.close()


if __name__ == "__main__":
    main()
