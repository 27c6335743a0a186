# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The dxslam authors
"""Cameras, options and trajectories: values in and out, and what is refused."""
import tempfile
import unittest
from pathlib import Path

import numpy as np

import dxslam

PINHOLE = {"width": 640, "height": 480, "fx": 500.0, "fy": 501.0, "cx": 320.0, "cy": 240.0}


class Cameras(unittest.TestCase):
    def test_fields(self):
        camera = dxslam.Camera(**PINHOLE, lens="kannala_brandt", k1=0.01, depth_factor=5000)
        self.assertEqual((camera.width, camera.fy, camera.depth_factor), (640, 501.0, 5000.0))
        self.assertEqual(camera.lens, "kannala_brandt")
        self.assertEqual(camera.lens_parameters["k1"], 0.01)
        with self.assertRaises(AttributeError):
            camera.fx = 1.0

    def test_refusals_are_those_of_camera_files(self):
        for changes, said in (({"fx": -1}, "fx is '-1', expected a number from 1"),
                              ({"k9": 1.0}, "unknown key 'k9', did you mean 'k"),
                              ({"lens": "fish"}, "lens is 'fish', expected one of radtan"),
                              ({"max_depth": float("nan")}, "max_depth is 'nan'")):
            with self.assertRaisesRegex(dxslam.InputError, said):
                dxslam.Camera(**PINHOLE | changes)

    def test_files_of_all_kinds(self):
        for name in dxslam.Camera.presets():
            camera = dxslam.Camera.load(name)
            self.assertEqual(dxslam.Camera.parse(camera.to_yaml()), camera)
            self.assertEqual(hash(dxslam.Camera.parse(camera.to_yaml())), hash(camera))
        ros = ("image_width: 640\nimage_height: 480\ndistortion_model: plumb_bob\n"
               "camera_matrix: {rows: 3, cols: 3, data: [500, 0, 320, 0, 501, 240, 0, 0, 1]}\n"
               "distortion_coefficients: {rows: 1, cols: 5, data: [0.1, 0, 0, 0, 0]}\n")
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "camera.yaml"
            path.write_text(ros, encoding="utf-8")
            camera = dxslam.Camera.load(path)
        self.assertEqual((camera.fx, camera.lens_parameters["k1"]), (500.0, 0.1))

    def test_geometry(self):
        camera = dxslam.Camera(**PINHOLE, k1=-0.2)
        points = np.array([[0.0, 0.0, 1.0], [0.5, -0.2, 2.0], [0.0, 0.0, -1.0]])
        raw = camera.project(points)
        self.assertTrue(np.allclose(raw[0], [320, 240]))
        self.assertTrue(np.isnan(raw[2]).all())
        ideal = camera.undistort(raw[:2])
        self.assertTrue(np.allclose(ideal[1], [320 + 500 * 0.25, 240 - 501 * 0.1]))
        self.assertTrue(np.allclose(camera.distort(ideal), raw[:2]))


class OptionsOfASystem(unittest.TestCase):
    def test_names_are_those_of_files(self):
        options = dxslam.Options(final_bundle=False, tracking={"min_inliers": 20})
        self.assertEqual(options.tracking.min_inliers, 20)
        options.tracking.min_inliers = np.int64(25)
        options.mapping = {}
        self.assertFalse(options.final_bundle)
        text = options.to_yaml()
        self.assertRegex(text, r"min_inliers: 25 +# .*points")  # with its meaning
        again = dxslam.Options.from_yaml(text)
        self.assertEqual(again, options)
        self.assertNotEqual(again, dxslam.Options())
        self.assertEqual(dxslam.Options(options.to_dict()), options)
        self.assertEqual(repr(options),
                         "Options({'final_bundle': False, 'tracking': {'min_inliers': 25}})")
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "my.yaml"
            path.write_text("tracking:\n  min_inliers: 30\n", encoding="utf-8")
            self.assertEqual(dxslam.Options.load(path).tracking.min_inliers, 30)
            with self.assertRaisesRegex(dxslam.InputError, "nothing.yaml.*expected a YAML"):
                dxslam.Options.load(Path(folder) / "nothing.yaml")

    def test_copies_are_their_own(self):
        options = dxslam.Options()
        copy = options.copy()
        copy.tracking.min_inliers = 99
        self.assertNotEqual(options.tracking.min_inliers, 99)

    def test_refusals_are_those_of_files(self):
        options = dxslam.Options()
        before = options.to_dict()
        with self.assertRaisesRegex(dxslam.InputError,
                                    "unknown key 'tracking.min_inlier', did you mean "
                                    "'tracking.min_inliers'"):
            options.tracking.min_inlier = 3
        with self.assertRaisesRegex(dxslam.InputError,
                                    "tracking.min_inliers is '0', expected a whole number from"):
            options.tracking.min_inliers = 0
        with self.assertRaisesRegex(dxslam.InputError, "final_bundle is 'maybe'"):
            dxslam.Options(final_bundle="maybe")
        with self.assertRaisesRegex(dxslam.InputError, r"my.yaml:2: unknown key 'foo'"):
            dxslam.Options.from_yaml("final_bundle: true\nfoo: 1\n", "my.yaml")
        with self.assertRaises(AttributeError):
            options.nothing
        self.assertEqual(options.to_dict(), before)

    def test_a_system_refuses_the_rest(self):
        camera = dxslam.Camera(**PINHOLE)
        with self.assertRaisesRegex(dxslam.InputError, "option mode is `dance`"):
            dxslam.System(camera, dxslam.Options(mode="dance"))
        with self.assertRaisesRegex(dxslam.InputError, "unknown features `none`"):
            dxslam.System(camera, dxslam.Options(features="none"))


class Trajectories(unittest.TestCase):
    def setUp(self):
        angles = np.linspace(0.0, 1.0, 20)
        self.poses = np.tile(np.eye(4), (20, 1, 1))
        self.poses[:, 0, 0] = self.poses[:, 2, 2] = np.cos(angles)
        self.poses[:, 0, 2] = np.sin(angles)
        self.poses[:, 2, 0] = -np.sin(angles)
        self.poses[:, :3, 3] = np.stack([angles, angles**2, np.sin(3 * angles)], axis=1)
        self.stamps = 1e9 + np.arange(20) / 30
        self.trajectory = dxslam.Trajectory(self.stamps, self.poses)

    def test_forms(self):
        self.assertEqual(len(self.trajectory), 20)
        self.assertTrue(np.allclose(self.trajectory.world_from_camera, self.poses))
        self.assertTrue(np.array_equal(self.trajectory.stamps, self.stamps))
        self.assertTrue(np.allclose(self.trajectory.positions, self.poses[:, :3, 3]))
        rows = np.asarray(self.trajectory)
        self.assertEqual(rows.shape, (20, 8))
        again = dxslam.Trajectory.from_tum(rows)
        self.assertTrue(np.allclose(again.world_from_camera, self.poses))

    def test_files(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "trajectory.txt"
            self.trajectory.write(path)
            again = dxslam.Trajectory.read(path)
        self.assertTrue(np.allclose(again.to_tum(), self.trajectory.to_tum(), atol=1e-6))

    def test_refusals(self):
        with self.assertRaisesRegex(dxslam.InputError, "pose 0 of the trajectory has no rigid"):
            dxslam.Trajectory(self.stamps, 2 * self.poses)
        with self.assertRaisesRegex(dxslam.InputError, "pose 1 .* rising stamps"):
            dxslam.Trajectory(self.stamps[::-1].copy(), self.poses)
        with self.assertRaisesRegex(dxslam.InputError, "19 stamps and 20 poses"):
            dxslam.Trajectory(self.stamps[1:], self.poses)
        with self.assertRaises(TypeError):
            dxslam.Trajectory(self.stamps, self.poses[:, :3])

    def test_evaluation(self):
        moved = self.poses.copy()
        moved[:, :3, 3] += [1.0, 2.0, 3.0]
        moved[7, 1, 3] += 0.1
        estimate = dxslam.Trajectory(self.stamps + 0.001, moved)
        report = dxslam.evaluate.ate(self.trajectory, estimate)
        self.assertEqual(report.position.count, 20)
        self.assertAlmostEqual(report.position.rmse, np.sqrt(np.mean(report.errors**2)))
        self.assertEqual(int(np.argmax(report.errors)), 7)
        self.assertLess(np.abs(report.truth_from_estimate[:3, 3] + [1, 2, 3]).max(), 0.1)
        raw = dxslam.evaluate.ate(self.trajectory, estimate, alignment="none")
        self.assertAlmostEqual(raw.position.min, np.sqrt(14.0))
        relative = dxslam.evaluate.rpe(self.trajectory, estimate)
        self.assertAlmostEqual(relative.translation.max, 0.1)
        self.assertEqual(relative.translation.count, 19)
        with self.assertRaisesRegex(dxslam.InputError, "alignment is 'sim'"):
            dxslam.evaluate.ate(self.trajectory, estimate, alignment="sim")
        with self.assertRaises(dxslam.InputError):
            dxslam.evaluate.ate(self.trajectory, dxslam.Trajectory(self.stamps + 99, self.poses))


if __name__ == "__main__":
    unittest.main()
