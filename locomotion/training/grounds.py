"""The grounds that people learn to go on: level, waves, ramps and moguls, 80 m by 80 m."""

import math
from functools import lru_cache

import numpy as np
from scipy.ndimage import map_coordinates

from locomotion.ground import Ground

__all__ = ["HALF", "KINDS", "ground_height", "training_ground"]

HALF = 40.0
"""Half the side [m] of a training ground."""
KINDS = ("level", "gentle", "rolling", "ramps", "moguls")
"""Waves with slopes up to 0.1 and up to 0.35; plateaus joined by ramps of a slope of 0.3, 12 m long; random
heights every 1.5 m, with a median slope of about 0.3."""
_MESH = 0.5  # [m] side of the squares
_WAVES = ((0.9, 0.35, 0.4), (-0.4, 0.8, 1.9), (0.55, -0.65, 3.1))  # (wave numbers x, y [1/m], phase)
_ALONG = (0.9, 0.43)  # direction in which the ramps rise
_PLATEAU, _RAMP, _STEEP = 3.0, 12.0, 0.3
_SPACING, _ROUGH = 1.5, 0.3  # [m] between the moguls' random heights; [m] of those


@lru_cache(maxsize=1)
def _random_heights() -> np.ndarray:
    count = math.ceil(2.0 * HALF / _SPACING) + 2
    return np.random.default_rng(5).uniform(-_ROUGH, _ROUGH, (count, count))


def ground_height(kind: str, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Height [m] of a ground of ``kind`` (one of `KINDS`) at the points ``x``, ``y`` (n,) within ±`HALF`."""
    if kind in ("gentle", "rolling"):
        waves = (np.sin(kx * x + ky * y + phase) / math.hypot(kx, ky) for kx, ky, phase in _WAVES)
        return (0.06 if kind == "gentle" else 0.2) * sum(waves, np.zeros_like(x))
    if kind == "ramps":
        u = np.mod(_ALONG[0] * x + _ALONG[1] * y, 2.0 * (_PLATEAU + _RAMP))
        return _STEEP * np.clip(np.minimum(u - _PLATEAU, 2.0 * (_PLATEAU + _RAMP) - u), 0.0, _RAMP)
    if kind == "moguls":
        return map_coordinates(_random_heights(), [(x + HALF) / _SPACING, (y + HALF) / _SPACING], order=1)
    return np.zeros_like(x)


@lru_cache(maxsize=len(KINDS))
def training_ground(kind: str) -> Ground:
    """The ground of a ``kind`` as a mesh."""
    n = round(2.0 * HALF / _MESH) + 1
    line = np.linspace(-HALF, HALF, n)
    x, y = (g.ravel() for g in np.meshgrid(line, line, indexing="ij"))
    corner = (np.arange(n - 1)[:, None] * n + np.arange(n - 1)).ravel()
    a, b, d, e = corner, corner + n, corner + n + 1, corner + 1
    faces = np.concatenate([np.stack([a, b, d], axis=1), np.stack([a, d, e], axis=1)])
    return Ground.from_arrays(np.stack([x, y, ground_height(kind, x, y)], axis=1), faces)
