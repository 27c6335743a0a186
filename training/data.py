# SPDX-License-Identifier: Apache-2.0
"""Training images: photos, and a posed RGB-D sequence, each giving pairs of views with known correspondences."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

Rng = np.random.Generator
Points = NDArray[np.float32]
Image = NDArray[np.uint8]
Transfer = Callable[[Points], Points]

PHOTO_SETS = ("nyuv2", "imagenet_667", "scene15")
LAST_TRAINING_FRAME = 598  # of redkitchen; later frames are for evaluation only
FOCAL_COLOUR, FOCAL_DEPTH, CENTRE = 525.0, 585.0, (320.0, 240.0)


@dataclass(frozen=True)
class View:
    """Two crops of one scene; `transfer` takes pixels of the first to the second, NaN where there is none."""

    first: Image
    second: Image
    transfer: Transfer


@dataclass(frozen=True)
class Frame:
    """One frame of a posed sequence, depth in metres registered to the colour image (0: none)."""

    number: int
    grey: Image
    depth: NDArray[np.float32]
    pose: NDArray[np.float64]


def photo_files(root: Path) -> list[Path]:
    """Every training photo, in a fixed order."""
    files = [f for name in PHOTO_SETS for f in (root / "train" / name).rglob("*.jp*g")]
    return sorted(files)


def load_photos(files: list[Path]) -> list[Image]:
    """Grey photos of at least 160 pixels a side."""
    images = (cv2.imread(str(f), cv2.IMREAD_GRAYSCALE) for f in files)
    return [i for i in images if i is not None and min(i.shape) >= 160]


def read_depth(path: Path) -> NDArray[np.float32]:
    """Depth in metres on the colour camera's pixels (the two cameras differ in focal length only)."""
    depth = cv2.imread(str(path), cv2.IMREAD_UNCHANGED).astype(np.float32)
    depth[depth == 65535] = 0
    height, width = depth.shape
    ratio = FOCAL_DEPTH / FOCAL_COLOUR
    u = np.rint((np.arange(width) - CENTRE[0]) * ratio + CENTRE[0]).astype(int)
    v = np.rint((np.arange(height) - CENTRE[1]) * ratio + CENTRE[1]).astype(int)
    inside = np.outer((v >= 0) & (v < height), (u >= 0) & (u < width))
    moved = depth[np.clip(v, 0, height - 1)][:, np.clip(u, 0, width - 1)]
    return np.where(inside, moved, 0).astype(np.float32) / np.float32(1000)


def load_frame(folder: Path, number: int) -> Frame:
    """One redkitchen frame."""
    stem = folder / f"frame-{number:06d}"
    grey = cv2.imread(f"{stem}.color.jpg", cv2.IMREAD_GRAYSCALE)
    return Frame(number, grey, read_depth(Path(f"{stem}.depth.png")), np.loadtxt(f"{stem}.pose.txt"))


def load_sequence(root: Path) -> list[Frame]:
    """The frames of redkitchen that may be trained on."""
    folder = root / "7scenes_redkitchen"
    return [load_frame(folder, n) for n in range(0, LAST_TRAINING_FRAME + 1, 2)]


def lift(frame: Frame, pixels: Points) -> NDArray[np.float64]:
    """World points of pixels; NaN where there is no depth."""
    height, width = frame.depth.shape
    u, v = np.rint(pixels[:, 0]).astype(int), np.rint(pixels[:, 1]).astype(int)
    inside = (u >= 0) & (u < width) & (v >= 0) & (v < height)
    z = np.where(inside, frame.depth[np.clip(v, 0, height - 1), np.clip(u, 0, width - 1)], 0).astype(np.float64)
    z[z <= 0] = np.nan
    rays = (pixels - np.float32(CENTRE)) / FOCAL_COLOUR
    camera = np.column_stack([rays * z[:, None], z])
    return camera @ frame.pose[:3, :3].T + frame.pose[:3, 3]


def project(frame: Frame, world: NDArray[np.float64]) -> tuple[Points, NDArray[np.float64]]:
    """Pixels and depths of world points; NaN behind the camera."""
    camera = (world - frame.pose[:3, 3]) @ frame.pose[:3, :3]
    z = np.where(camera[:, 2] > 0.1, camera[:, 2], np.nan)
    return (camera[:, :2] / z[:, None] * FOCAL_COLOUR + CENTRE).astype(np.float32), z


def reproject(first: Frame, second: Frame, pixels: Points) -> Points:
    """Pixels of the first frame seen in the second, NaN where hidden, outside or without depth."""
    moved, z = project(second, lift(first, pixels))
    height, width = second.depth.shape
    u, v = np.nan_to_num(np.rint(moved[:, 0]), nan=-1), np.nan_to_num(np.rint(moved[:, 1]), nan=-1)
    inside = (u >= 0) & (u < width) & (v >= 0) & (v < height)
    seen = second.depth[np.clip(v, 0, height - 1).astype(int), np.clip(u, 0, width - 1).astype(int)]
    good = inside & (seen > 0) & (np.abs(seen - z) < 0.05 + 0.03 * z)
    moved[~good] = np.nan
    return moved


def transform(matrix: NDArray[np.float64], pixels: Points) -> Points:
    """Pixels moved by a 3x3 homography."""
    return cv2.perspectiveTransform(pixels[None].astype(np.float32), matrix)[0]


class PhotoPairs:
    """Two random perspective views of one photo."""

    def __init__(self, photos: list[Image], height: int, width: int) -> None:
        self.photos, self.height, self.width = photos, height, width

    def _quad(self, shape: tuple[int, ...], rng: Rng, near: NDArray[np.float64] | None) -> NDArray[np.float32]:
        """Corners in the photo of a crop; close to the crop `near` if one is given."""
        rows, columns = shape
        aspect = self.height / self.width
        size = min(columns, rows / aspect) * rng.uniform(0.55, 1.0)
        if near is None:
            x, y = rng.uniform(0, columns - size), rng.uniform(0, rows - size * aspect)
        else:
            size = float(np.clip(np.linalg.norm(near[1] - near[0]) * np.exp(rng.normal(0, 0.22)), 120, columns))
            x, y = near.mean(0) - (size / 2, size * aspect / 2) + rng.normal(0, 0.08 * size, 2)
        quad = np.array([[x, y], [x + size, y], [x + size, y + size * aspect], [x, y + size * aspect]])
        angle = np.deg2rad(rng.normal(0, 12))
        turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
        centre = quad.mean(0)
        return ((quad - centre) @ turn.T + centre + rng.normal(0, 0.055 * size, (4, 2))).astype(np.float32)

    def _warp(self, photo: Image, quad: NDArray[np.float32]) -> tuple[Image, NDArray[np.float64]]:
        w, h = self.width, self.height
        matrix = cv2.getPerspectiveTransform(quad, np.float32([[0, 0], [w, 0], [w, h], [0, h]]))
        crop = cv2.warpPerspective(photo, matrix, (w, h), flags=cv2.INTER_LINEAR, borderMode=cv2.BORDER_REFLECT)
        return crop, matrix

    def __call__(self, rng: Rng) -> View:
        photo = self.photos[rng.integers(len(self.photos))]
        if rng.random() < 0.5:
            photo = cv2.flip(photo, 1)
        quad = self._quad(photo.shape, rng, None)
        first, to_first = self._warp(photo, quad)
        second, to_second = self._warp(photo, self._quad(photo.shape, rng, quad))
        matrix = to_second @ np.linalg.inv(to_first)
        return View(first, second, lambda p: transform(matrix, p))


class SequencePairs:
    """Crops of two frames that see the same place, linked by depth and pose."""

    def __init__(self, frames: list[Frame], height: int, width: int) -> None:
        self.frames, self.height, self.width = frames, height, width
        centres = np.array([f.pose[:3, 3] for f in frames])
        axes = np.array([f.pose[:3, 2] for f in frames])
        near = np.linalg.norm(centres[:, None] - centres[None], axis=2) < 1.0
        near &= axes @ axes.T > np.cos(np.deg2rad(40))
        near &= np.abs(np.subtract.outer(np.arange(len(frames)), np.arange(len(frames)))) >= 4
        self.partners = [np.flatnonzero(row) for row in near]

    def _crop(self, grey: Image, centre: Points, scale: float, rng: Rng) -> tuple[Image, NDArray[np.float64]]:
        """A crop around a pixel, `scale` source pixels a crop pixel; and the matrix from source to crop."""
        turn = cv2.getRotationMatrix2D((float(centre[0]), float(centre[1])), rng.normal(0, 8), 1 / scale)
        turn[:, 2] += np.array([self.width / 2, self.height / 2]) - centre
        size = (self.width, self.height)
        crop = cv2.warpAffine(grey, turn, size, flags=cv2.INTER_LINEAR, borderMode=cv2.BORDER_REFLECT)
        return crop, np.vstack([turn, [0, 0, 1]])

    def __call__(self, rng: Rng) -> View:
        while True:
            i = int(rng.integers(len(self.frames)))
            if len(self.partners[i]) == 0:
                continue
            a, b = self.frames[i], self.frames[int(rng.choice(self.partners[i]))]
            scale = rng.uniform(1.0, 1.8)
            margin = np.array([self.width, self.height]) * scale / 2
            centre = rng.uniform(margin, (640 - margin[0], 480 - margin[1])).astype(np.float32)
            probe = centre + rng.uniform(-0.6, 0.6, (40, 2)).astype(np.float32) * margin.astype(np.float32)
            moved = reproject(a, b, probe)
            good = np.isfinite(moved[:, 0])
            if good.sum() >= 12:
                break
        first, to_first = self._crop(a.grey, centre, scale, rng)
        target = np.median(moved[good] - probe[good], axis=0) + centre + rng.normal(0, 12, 2)
        scale = float(np.clip(scale * np.exp(rng.normal(0, 0.12)), 1.0, 1.8))
        margin = np.array([self.width, self.height]) * scale / 2
        target = np.clip(target, margin, (640, 480) - margin)
        second, to_second = self._crop(b.grey, target, scale, rng)
        back = np.linalg.inv(to_first)
        return View(first, second, lambda p: transform(to_second, reproject(a, b, transform(back, p))))
