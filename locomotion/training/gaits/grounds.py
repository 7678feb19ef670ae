"""Training grounds: level, waves, ramps, moguls, crags, ridges and stairs, 80 m by 80 m."""

import math
from functools import lru_cache

import numpy as np
from scipy.ndimage import map_coordinates

from locomotion.ground.ground import Ground, extruded

__all__ = ["FLIGHTS", "HALF", "KINDS", "ground_height", "training_ground"]

HALF = 40.0
"""Half the side [m] of a training ground."""
KINDS = ("level", "gentle", "rolling", "ramps", "moguls", "crags", "ridges", "stairs")
"""Level; waves with slopes of up to 0.15 (gentle) and 0.5 (rolling), half of that in most places; plateaus
joined by ramps 12 m long with a slope of 0.3; moguls, random heights every 1.5 m with slopes of up to 0.5,
0.17 in the median; crags, random heights every 2.2 m with slopes of up to 0.44, the steepest on which people
still walk; ridges 10 m apart with flanks of 0.2 to 0.45; flights of stairs across, see `FLIGHTS`."""
_STEPS, _LANDING = 7, 2.6  # of a flight; [m] between flights
_RISERS, _PACE = (0.12, 0.2), 0.63  # [m] heights of the steps of the flights; twice such a height and a tread


def _flights() -> tuple[tuple[float, float, float, float], ...]:
    result, x = [], 1.0 - HALF
    for k, riser in enumerate(np.random.default_rng(5).permutation(np.linspace(*_RISERS, 16))):
        tread = max(_PACE - 2.0 * riser, 0.27)
        result.append((x + _LANDING, float(tread), float(riser) * (-1.0) ** k, x + _LANDING + _STEPS * tread))
        x = result[-1][3]
    return tuple(result)


FLIGHTS = _flights()
"""Flights of stairs in proportions that people build. For each: x of its first front, depth of its treads,
height of its steps (negative where it leads down along x), x of the end of its last tread [m]."""
_MESH = 0.5  # [m] side of the squares
_WAVES = ((0.9, 0.35, 0.4), (-0.4, 0.8, 1.9), (0.55, -0.65, 3.1))  # (wave numbers x, y [1/m], phase)
_ALONG = (0.9, 0.43)  # direction in which the ramps rise
_PLATEAU, _RAMP, _STEEP = 3.0, 12.0, 0.3
_SPACING = {"moguls": 1.5, "crags": 2.2}  # [m] between random heights
_ROUGH = {"moguls": 0.3, "crags": 5.0}  # [m] of those
_FLANK, _FLANKS = 5.0, (0.2, 0.45)  # [m] from a ridge to the next valley; slopes there
_STEEPEST = {"crags": 0.44, "ridges": _FLANKS[1]}  # their slopes


@lru_cache(maxsize=len(_SPACING))
def _random_heights(kind: str) -> np.ndarray:
    count = math.ceil(2.0 * HALF / _SPACING[kind]) + 2
    heights = np.random.default_rng(5).uniform(-_ROUGH[kind], _ROUGH[kind], (count, count))
    if kind in _STEEPEST:
        _limit_slopes(heights, _STEEPEST[kind] * _SPACING[kind] / math.sqrt(2.0))
    return heights


def _limit_slopes(heights: np.ndarray, most: float) -> None:
    """Flatten ``heights`` (n, n) in place until no two neighbours in a row or column differ by more than
    ``most``."""
    while True:
        excess = 0.0
        for axis in (0, 1):
            lines = np.moveaxis(heights, axis, 0)
            for start in (0, 1):
                low, high = lines[start:-1:2], lines[start + 1 :: 2]
                over = high - low - np.clip(high - low, -most, most)
                excess = max(excess, float(np.abs(over).max()))
                low += 0.5 * over
                high -= 0.5 * over
        if excess < 1e-6:
            return


def ground_height(kind: str, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Height [m] of a ground of ``kind`` (one of `KINDS`) at the points ``x``, ``y`` (n,) within ±`HALF`."""
    if kind in ("gentle", "rolling"):
        waves = (np.sin(kx * x + ky * y + phase) / math.hypot(kx, ky) for kx, ky, phase in _WAVES)
        return (0.06 if kind == "gentle" else 0.2) * sum(waves, np.zeros_like(x))
    if kind == "ramps":
        u = np.mod(_ALONG[0] * x + _ALONG[1] * y, 2.0 * (_PLATEAU + _RAMP))
        return _STEEP * np.clip(np.minimum(u - _PLATEAU, 2.0 * (_PLATEAU + _RAMP) - u), 0.0, _RAMP)
    if kind == "ridges":
        u, creases = _ALONG[0] * x + _ALONG[1] * y, np.arange(-12, 13)
        slopes = np.random.default_rng(5).permutation(np.linspace(*_FLANKS, len(creases) - 1))
        rises = _FLANK * slopes * np.where(creases[:-1] % 2, -1.0, 1.0)
        return np.interp(u, _FLANK * creases, np.concatenate([[0.0], np.cumsum(rises)]))
    if kind == "stairs":
        z = np.zeros_like(x)
        for begin, tread, riser, _ in FLIGHTS:
            z += riser * np.clip(np.floor((x - begin) / tread) + 1.0, 0.0, _STEPS)
        return z
    if kind in _SPACING:
        cells = [(x + HALF) / _SPACING[kind], (y + HALF) / _SPACING[kind]]
        return map_coordinates(_random_heights(kind), cells, order=1)
    return np.zeros_like(x)


@lru_cache(maxsize=len(KINDS))
def training_ground(kind: str) -> Ground:
    """The ground of a ``kind`` as a mesh."""
    if kind == "stairs":
        return _stairs()
    n = round(2.0 * HALF / _MESH) + 1
    line = np.linspace(-HALF, HALF, n)
    x, y = (g.ravel() for g in np.meshgrid(line, line, indexing="ij"))
    corner = (np.arange(n - 1)[:, None] * n + np.arange(n - 1)).ravel()
    a, b, d, e = corner, corner + n, corner + n + 1, corner + 1
    faces = np.concatenate([np.stack([a, b, d], axis=1), np.stack([a, d, e], axis=1)])
    corners = np.stack([x, y, ground_height(kind, x, y)], axis=1)
    return Ground.from_arrays(corners, faces, max_slope=math.atan(_STEEPEST.get(kind, 0.0)))


def _stairs() -> Ground:
    fronts = np.concatenate([begin + tread * np.arange(_STEPS) for begin, tread, _, _ in FLIGHTS])
    rises = np.cumsum(np.repeat([riser for _, _, riser, _ in FLIGHTS], _STEPS))
    x = np.concatenate([[-HALF], np.repeat(fronts, 2), [HALF]])
    z = np.repeat(np.concatenate([[0.0], rises]), 2)
    return Ground.from_arrays(*extruded(np.column_stack([x, z]), HALF))
