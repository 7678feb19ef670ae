"""Which chunks of an open world are loaded and dropped next."""

from math import inf

import numpy as np

__all__ = ["HOLD", "distances", "in_order", "nearness"]

HOLD = 20.0
"""[m] around a body within which no chunk is dropped: as far as the fastest goes while a change is worked
out, and then needs to come to a stand."""


def distances(points: np.ndarray, bounds: np.ndarray) -> np.ndarray:
    """(k, c) [m]: how far ``points`` (k, 3) are from boxes (c, 2, 3), seen from above."""
    low, high = bounds[:, 0, :2], bounds[:, 1, :2]
    at = points[:, None, :2]
    off = np.maximum(np.maximum(low - at, at - high), 0.0)
    return np.hypot(off[..., 0], off[..., 1])


def nearness(bounds: np.ndarray, points: np.ndarray) -> np.ndarray:
    """(c,) [m]: how far each of the boxes (c, 2, 3) is from the nearest of ``points`` (k, 3), seen from
    above."""
    return distances(points, bounds).min(axis=0, initial=inf)


def in_order(off: np.ndarray, comes: np.ndarray, goes: np.ndarray) -> list[int]:
    """The chunks that are to be loaded, the nearest first, and after them those that are to be dropped, the
    farthest first: ``comes`` and ``goes`` (c,) bool, ``off`` (c,) [m]. Equally far ones come in order and go
    in the opposite order."""
    order = np.argsort(off, kind="stable")
    back = order[::-1]
    return [*order[comes[order]].tolist(), *back[goes[back]].tolist()]
