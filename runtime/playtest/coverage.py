"""How much of the floor the bots have seen, and when."""

import numpy as np
from scipy.spatial import KDTree

__all__ = ["Coverage"]

_MOMENTS = 60  # points of the curve
_SEEN = 1.0  # [m] a patch is covered when a bot has been this near to it


class Coverage:
    """The ``patches`` (n, 3) [m] of floor that can be reached, with their first and all visits."""

    def __init__(self, patches: np.ndarray) -> None:
        self._patches = patches
        self._tree = KDTree(patches)
        self._first = np.full(len(patches), np.inf)
        self._visits = np.zeros(len(patches), dtype=np.int64)

    def add(self, track: np.ndarray) -> None:
        """Add a bot's ``track`` (m, 4): time [s] and place [m]."""
        if not len(track):
            return
        away, nearest = (np.asarray(each) for each in self._tree.query(track[:, 1:]))
        near = away <= _SEEN
        np.minimum.at(self._first, nearest[near], track[near, 0])
        np.add.at(self._visits, nearest[near], 1)

    def curve(self, seconds: float) -> tuple[tuple[float, float], ...]:
        """Moments up to ``seconds`` [s], and the share of patches that was seen by then."""
        moments = np.linspace(0.0, seconds, _MOMENTS + 1)
        share = np.searchsorted(np.sort(self._first), moments, side="right") / max(len(self._patches), 1)
        return tuple((round(float(t), 2), round(float(s), 4)) for t, s in zip(moments, share, strict=True))

    def visits(self) -> tuple[tuple[float, float, float, int], ...]:
        """Each patch and how often a bot was there."""
        places = np.round(self._patches, 2).tolist()
        return tuple((x, y, z, int(n)) for (x, y, z), n in zip(places, self._visits, strict=True))
