# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The dxslam authors
"""Maps: on the disk and back, joined, searched, gone on with."""
import tempfile
import unittest
from pathlib import Path

import numpy as np

import dxslam
import recording


class Maps(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory(prefix="dxslam_python_")
        cls.addClassCleanup(folder.cleanup)
        cls.folder = Path(folder.name)
        cls.slam, _, _ = recording.finished()
        cls.made = cls.slam.map()
        cls.file = cls.folder / "map.dxmap"
        cls.made.save(cls.file)
        cls.loaded = dxslam.Map.load(cls.file)

    def test_comes_back(self):
        for rows in ("keyframes", "points"):
            made, loaded = getattr(self.made, rows)(), getattr(self.loaded, rows)()
            self.assertEqual(len(made), len(loaded))
        self.assertTrue(np.array_equal(self.made.keyframes().world_from_camera,
                                       self.loaded.keyframes().world_from_camera))
        self.assertTrue(np.array_equal(self.made.points().positions,
                                       self.loaded.points().positions))
        self.assertEqual(self.loaded.cameras, [recording.source().camera])
        self.assertEqual(self.loaded.features, "hfnet")

    def test_keyframes_see_points(self):
        known = self.loaded.points()
        for id in self.loaded.keyframes().ids.tolist():
            keyframe = self.loaded.keyframe(id)
            seen = keyframe.points >= 0
            self.assertEqual(len(keyframe.pixels), len(keyframe.depths))
            self.assertEqual(len(keyframe.pixels), len(keyframe.descriptors))
            self.assertGreater(seen.sum(), 20)
            rows = np.searchsorted(known.ids, keyframe.points[seen])
            world = np.c_[known.positions[rows], np.ones(len(rows))]
            here = world @ np.linalg.inv(keyframe.world_from_camera).T
            errors = np.linalg.norm(recording.source().camera.project(here[:, :3])
                                    - keyframe.pixels[seen], axis=1)
            self.assertLess(np.median(errors), 2.0)
            self.assertIsNone(self.loaded.thumbnail(id))
        with self.assertRaises(dxslam.ContractError):
            self.loaded.keyframe(10_000)

    def test_damaged_files_are_refused_and_others_kept(self):
        broken = self.folder / "broken.dxmap"
        broken.write_bytes(self.file.read_bytes()[:-100])
        with self.assertRaisesRegex(dxslam.InputError, "broken.dxmap"):
            dxslam.Map.load(broken)
        mine = self.folder / "mine.txt"
        mine.write_text("mine", encoding="utf-8")
        with self.assertRaisesRegex(dxslam.InputError, "mine.txt"):
            self.loaded.save(mine)
        self.assertEqual(mine.read_text(encoding="utf-8"), "mine")

    def test_finds_images(self):
        truth = {f.stamp: f.world_from_camera for f in self.slam.frames()}
        for stamp, color, depth in recording.images()[3::9]:
            found = self.loaded.relocalize(color, depth)
            self.assertTrue(found, stamp)
            self.assertGreater(found.confidence, 0.5)
            self.assertLess(np.abs(found.world_from_camera - truth[stamp]).max(), 0.03)
            raw = np.round(depth * recording.source().camera.depth_factor).astype(np.uint16)
            same = self.loaded.relocalize(color, raw, camera=recording.source().camera,
                                          extractor=recording.network())
            self.assertLess(np.abs(found.world_from_camera - same.world_from_camera).max(), 1e-3)

    def test_does_not_find_what_is_not_there(self):
        noise = np.random.default_rng(1).integers(0, 255, (480, 640, 3)).astype(np.uint8)
        found = self.loaded.relocalize(noise, extractor=recording.network())
        self.assertFalse(found)
        self.assertLess(found.confidence, 0.5)

    def test_other_features_are_refused(self):
        _, color, depth = recording.images()[0]
        with self.assertRaisesRegex(dxslam.InputError, "map.dxmap: .* features `hfnet`"):
            self.loaded.relocalize(color, depth, extractor=recording.extractor())
        with self.assertRaisesRegex(dxslam.InputError, "map.dxmap: .* features `hfnet`"):
            recording.system().load_map(self.loaded)

    def test_merges(self):
        apart = self.made.merge(self.loaded, apart=True)
        count = len(self.made.keyframes())
        self.assertEqual(len(apart.keyframes()), 2 * count)
        self.assertEqual(set(apart.keyframes().components.tolist()), {0, 1})
        joined = self.made.merge(self.loaded)
        self.assertEqual(set(joined.keyframes().components.tolist()), {0})
        self.assertGreater(len(joined.loops), 0)
        poses = joined.keyframes().world_from_camera
        self.assertLess(np.abs(poses[:count] - poses[count:2 * count]).max(), 0.03)
        self.assertEqual(len(self.made.keyframes()), count)
        with self.assertRaisesRegex(TypeError, "takes other maps"):
            self.made.merge(self.file)
        joined.save(self.folder / "joined.dxmap")
        self.assertEqual(len(dxslam.Map.load(self.folder / "joined.dxmap").keyframes()),
                         len(joined.keyframes()))

    def test_goes_on_another_day(self):
        options = dxslam.Options(mode="localization")
        with recording.system(extractor=recording.network(), options=options) as slam:
            slam.load_map(self.loaded)
            for image in recording.images()[10:16]:
                slam.process(*image)
        truth = {f.stamp: f.world_from_camera for f in self.slam.frames()}
        self.assertEqual(len(slam.trajectory()), 6)
        for stamp, pose in zip(slam.trajectory().stamps, slam.trajectory().world_from_camera):
            self.assertLess(np.abs(pose - truth[stamp]).max(), 0.03)

    def test_exports(self):
        self.loaded.export_ply(self.folder / "map.ply")
        self.assertTrue((self.folder / "map.ply").read_bytes().startswith(b"ply\n"))
        self.loaded.export_colmap(self.folder / "colmap")
        self.assertTrue((self.folder / "colmap" / "0" / "images.txt").is_file())

    def test_outlives_its_system(self):
        with recording.system() as slam:
            for image in recording.images()[:4]:
                slam.process(*image)
        kept = slam.map()
        del slam
        self.assertGreater(len(kept.points()), 50)


if __name__ == "__main__":
    unittest.main()
