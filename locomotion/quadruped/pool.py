"""Tables of different lengths in one array, one per owner."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

__all__ = ["Pool"]


class Pool:
    """Rows of ``width`` float64 in one array ``rows``; an owner's are ``rows[start : start + count]``."""

    def __init__(self, width: int) -> None:
        self.rows = np.zeros((1024, width))
        self._used = 0
        self._regions: dict[int, tuple[int, int]] = {}

    def put(self, owner: int, table: NDArray[np.float64]) -> bool:
        """Set the table (k, width) of ``owner``; True if those of others have moved."""
        self._regions.pop(owner, None)
        moved = self._used + len(table) > len(self.rows)
        if moved:
            self._pack(len(table))
        self.rows[self._used : self._used + len(table)] = table
        self._regions[owner] = (self._used, len(table))
        self._used += len(table)
        return moved

    def remove(self, owner: int) -> None:
        """Remove the table of ``owner``; the numbers of owners after it decrease by one."""
        self._regions.pop(owner, None)
        self._regions = {each - (each > owner): region for each, region in self._regions.items()}

    def region(self, owner: int) -> tuple[int, int]:
        """(start, count) of an owner's table; (0, 0) for none."""
        return self._regions.get(owner, (0, 0))

    def table(self, owner: int) -> NDArray[np.float64]:
        """A copy of an owner's table."""
        start, count = self.region(owner)
        return self.rows[start : start + count].copy()

    def _pack(self, more: int) -> None:
        """Close the gaps, and make room for ``more`` rows and as many again as are in use."""
        live = sum(count for _, count in self._regions.values())
        rows = np.zeros((max(2 * (live + more), 1024), self.rows.shape[1]))
        at = 0
        for owner, (start, count) in self._regions.items():
            rows[at : at + count] = self.rows[start : start + count]
            self._regions[owner] = (at, count)
            at += count
        self.rows, self._used = rows, at
