# SPDX-License-Identifier: Apache-2.0
"""Photometric degradations that the student sees and the teacher does not."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

Image = NDArray[np.float32]
Rng = np.random.Generator

LOW_LIGHT_SHARE = 0.32
PHOTOMETRIC_SHARE = 0.34  # the rest stays as it is, shadows and blur excepted


def log_uniform(rng: Rng, low: float, high: float) -> float:
    """A number whose logarithm is uniform."""
    return float(np.exp(rng.uniform(np.log(low), np.log(high))))


def low_light(image: Image, rng: Rng) -> Image:
    """Darkness down to a fiftieth, with photon and read noise; the image is in 0..1."""
    dark = image ** np.float32(rng.uniform(1.2, 2.6)) * np.float32(log_uniform(rng, 0.02, 0.7))
    photons = log_uniform(rng, 200, 1500)
    noisy = rng.poisson(dark * photons).astype(np.float32) / np.float32(photons)
    read = np.float32(rng.uniform(0.002, 0.01))
    return noisy + read * rng.standard_normal(image.shape, dtype=np.float32)


def photometric(image: Image, rng: Rng) -> Image:
    """Contrast, brightness (over-exposure included), gamma and sensor noise."""
    gain = rng.uniform(1.3, 2.6) if rng.random() < 0.2 else rng.uniform(0.5, 1.5)
    shifted = np.clip((image - 0.5) * np.float32(gain) + np.float32(0.5 + rng.uniform(-0.25, 0.3)), 0, 1)
    curved = shifted ** np.float32(rng.uniform(0.6, 1.7))
    return curved + np.float32(rng.uniform(0, 0.04)) * rng.standard_normal(image.shape, dtype=np.float32)


def shade(image: Image, rng: Rng) -> Image:
    """A linear brightness gradient, or a soft-edged polygonal shadow."""
    height, width = image.shape
    if rng.random() < 0.5:
        ramp = np.linspace(rng.uniform(0.35, 1), rng.uniform(0.35, 1), width, dtype=np.float32)[None]
        return image * (ramp if rng.random() < 0.7 else np.resize(ramp, (1, height)).T)
    corners = (rng.random((rng.integers(3, 6), 2)) * (width, height)).astype(np.int32)
    mask = np.zeros((height, width), np.float32)
    cv2.fillPoly(mask, [cv2.convexHull(corners)], 1.0)
    mask = cv2.blur(mask, (2 * int(rng.integers(1, 8)) + 1,) * 2)
    return image * (1 - mask * np.float32(rng.uniform(0.3, 0.75)))


def blur(image: Image, rng: Rng) -> Image:
    """Defocus or motion blur."""
    if rng.random() < 0.6:
        return cv2.GaussianBlur(image, (0, 0), rng.uniform(0.4, 1.5))
    length = int(rng.integers(3, 8))
    kernel = np.zeros((length, length), np.float32)
    kernel[length // 2] = 1.0 / length
    turn = cv2.getRotationMatrix2D((length / 2 - 0.5, length / 2 - 0.5), rng.uniform(0, 180), 1)
    kernel = cv2.warpAffine(kernel, turn, (length, length))
    return cv2.filter2D(image, -1, kernel / max(float(kernel.sum()), 1e-6))


def degrade(image: NDArray[np.uint8], rng: Rng) -> NDArray[np.uint8]:
    """A random degradation, rounded down to 8 bits as a camera would."""
    out = image.astype(np.float32) / np.float32(255)
    if rng.random() < 0.25:
        out = shade(out, rng)
    if rng.random() < 0.25:
        out = blur(out, rng)
    kind = rng.random()
    if kind < LOW_LIGHT_SHARE:
        out = low_light(np.clip(out, 0, 1), rng)
    elif kind < LOW_LIGHT_SHARE + PHOTOMETRIC_SHARE:
        out = photometric(out, rng)
    return np.clip(out * 255, 0, 255).astype(np.uint8)
