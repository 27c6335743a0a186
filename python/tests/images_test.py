# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The dxslam authors
"""Images between NumPy and C++: what is shared, what is copied, what is refused."""
import sys
import unittest

import numpy as np

import dxslam
import recording


class Images(unittest.TestCase):
    def test_sources_share_their_memory(self):
        image = recording.source().read(3)
        self.assertEqual(image.index, 3)
        self.assertEqual((image.color.dtype, image.depth.dtype), (np.uint8, np.float32))
        self.assertTrue(np.shares_memory(image.color, image.color))
        color = image.color
        with self.assertRaises(ValueError):
            color[0, 0] = 0
        copy = color.copy()
        del image
        self.assertTrue(np.array_equal(color, copy))  # the array keeps what it shows

    def test_layouts_are_the_same_image(self):
        _, color, _ = recording.images()[0]
        expected = recording.extractor().extract(color)
        height, width = color.shape[:2]
        padded = np.zeros((height, width + 8, 3), np.uint8)
        padded[:, :width] = color
        mirrored = np.ascontiguousarray(color[:, ::-1])
        for same in (padded[:, :width], np.asfortranarray(color), mirrored[:, ::-1]):
            self.assertFalse(same.flags.c_contiguous)
            features = recording.extractor().extract(same)
            self.assertTrue(np.array_equal(features.keypoints, expected.keypoints))
            self.assertTrue(np.array_equal(features.descriptors, expected.descriptors))
        grey = recording.extractor().extract(np.ascontiguousarray(color[:, :, 1]))
        self.assertGreater(len(grey), 100)

    def test_nothing_keeps_an_array_longer_than_it_needs_it(self):
        stamp, color, depth = recording.images()[0]
        color, depth = color.copy(), depth.copy()
        before = sys.getrefcount(color), sys.getrefcount(depth)
        recording.extractor().extract(color)
        slam = recording.system()
        slam.process(stamp, color, depth)
        slam.finish()
        del slam
        self.assertEqual((sys.getrefcount(color), sys.getrefcount(depth)), before)

    def test_what_is_no_image_is_refused(self):
        extract = recording.extractor().extract
        for array, said in ((np.zeros((48, 64)), r"float64 of shape \(48, 64\)"),
                            (np.zeros((48, 64, 4), np.uint8), r"uint8 of shape \(48, 64, 4\)"),
                            (np.zeros(48, np.uint8), r"uint8 of shape \(48,\)"),
                            (np.zeros((0, 64), np.uint8), r"uint8 of shape \(0, 64\)"),
                            (np.zeros((), np.uint8), "uint8 of shape"),
                            (np.zeros((48, 64, 3), np.int8), "int8 of shape")):
            with self.assertRaisesRegex(dxslam.InputError,
                                        f"the colour image is {said}.*, expected uint8 of shape"):
                extract(array)
        with self.assertRaises(TypeError):
            extract("image.png")

    def test_what_does_not_fit_the_camera_is_refused_and_ends_nothing(self):
        stamp, color, depth = recording.images()[0]
        with recording.system() as slam:
            with self.assertRaisesRegex(dxslam.InputError, "colour image is 639 x 480, expected 640"):
                slam.process(stamp, color[:, :-1], depth)
            with self.assertRaisesRegex(dxslam.InputError, "depth image is 640 x 479, expected 640"):
                slam.process(stamp, color, depth[:-1])
            with self.assertRaisesRegex(dxslam.InputError, "depth image is float64 .* expected float32"):
                slam.process(stamp, color, depth.astype(np.float64))
            with self.assertRaisesRegex(dxslam.InputError, "stamp is nan, expected seconds"):
                slam.process(float("nan"), color, depth)
            slam.process(stamp, color, depth)
            with self.assertRaisesRegex(dxslam.InputError, "expected rising ones, or begin_sequence"):
                slam.process(stamp, color, depth)
        self.assertEqual(len(slam.frames()), 1)
        self.assertEqual(slam.frames()[0].index, 0)


class Extraction(unittest.TestCase):
    def test_features(self):
        _, color, _ = recording.images()[0]
        features = recording.network().extract(color)
        extractor = recording.network()
        self.assertEqual(features.keypoints.shape, (len(features), 4))
        self.assertTrue(np.all(np.diff(features.keypoints[:, 2]) <= 0))  # by falling score
        self.assertEqual(features.descriptors.shape, (len(features), extractor.dimension))
        self.assertTrue(np.allclose(np.linalg.norm(features.descriptors, axis=1), 1, atol=1e-3))
        self.assertEqual(features.global_descriptor.shape, (extractor.global_dimension,))
        self.assertIsNone(extractor.extract(color, with_global=False).global_descriptor)

    def test_matching(self):
        for extractor in (recording.network(), recording.extractor()):
            a, b = (extractor.extract(recording.images()[i][1]) for i in (0, 1))
            pairs, distances = dxslam.match(a.descriptors, b.descriptors, extractor.max_distance)
            self.assertGreater(len(pairs), 50)
            self.assertEqual((pairs.shape[1], pairs.dtype, len(distances)), (2, np.int32, len(pairs)))
            self.assertLessEqual(distances.max(), extractor.max_distance)
            first, second = a.descriptors[pairs[0, 0]], b.descriptors[pairs[0, 1]]
            distance = (np.unpackbits(first ^ second).sum() if extractor.is_binary
                        else np.linalg.norm(first - second))
            self.assertAlmostEqual(float(distances[0]), float(distance), places=3)
            fewer, _ = dxslam.match(a.descriptors, b.descriptors, extractor.max_distance, 0.8)
            self.assertLess(len(fewer), len(pairs))
        with self.assertRaisesRegex(dxslam.InputError, "two kinds"):
            dxslam.match(a.descriptors, np.zeros((4, a.descriptors.shape[1]), np.float32))


if __name__ == "__main__":
    unittest.main()
