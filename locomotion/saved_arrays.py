"""Ranges of the numbers in a body's memory arrays."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from locomotion.errors import LocomotionError

__all__ = ["COUNT", "FARTHEST", "FLAG", "SIDE", "Slots", "check_array", "check_number"]

FARTHEST = 1e9
"""The greatest number that is no mistake; coordinates [m] reach as far."""
COUNT, FLAG, SIDE = (0.0, FARTHEST), (0.0, 1.0), (-1.0, 1.0)
"""Ranges of a count, of what is 0 or 1, and of left (1) or right (-1)."""
Slot = int | slice


class Slots:
    """``what`` is an array of ``size`` numbers. ``ranges``: least and greatest of some of them; the others
    are only finite. ``whole``: those that are whole numbers. ``open_ended``: those that may be infinite or
    NaN.
    """

    def __init__(
        self,
        what: str,
        size: int,
        ranges: Sequence[tuple[Slot, tuple[float, float]]],
        whole: Sequence[Slot] = (),
        open_ended: Sequence[Slot] = (),
    ) -> None:
        self.what, self.size = what, size
        self._low, self._high = np.full(size, -FARTHEST), np.full(size, FARTHEST)
        self._whole, self._open = np.zeros(size, np.bool_), np.zeros(size, np.bool_)
        for slot, (low, high) in ranges:
            self._low[slot], self._high[slot] = low, high
        for slot in whole:
            self._whole[slot] = True
        for slot in open_ended:
            self._open[slot] = True

    def check(self, values: NDArray[np.float64]) -> None:
        """Raise `LocomotionError` if the numbers are not valid for ``what``."""
        if values.shape != (self.size,) or values.dtype != np.float64:
            raise LocomotionError(f"{self.what} has shape {values.shape}, expected ({self.size},)")
        fits = (values >= self._low) & (values <= self._high) | self._open
        fits &= ~self._whole | (values == np.floor(values))
        if not fits.all():
            at = int(np.argmin(fits))
            kind = "a whole number" if self._whole[at] else "a number"
            raise LocomotionError(
                f"{self.what}: number {at} is {values[at]:g}, expected {kind} from {self._low[at]:g} to "
                f"{self._high[at]:g}"
            )


def check_number(what: str, value: float, low: float = -FARTHEST, high: float = FARTHEST) -> None:
    """Raise `LocomotionError` for a ``value`` outside of ``low`` to ``high``, or NaN."""
    if not low <= value <= high:
        raise LocomotionError(f"{what} is {value}, expected {low:g} to {high:g}")


def check_array(what: str, values: NDArray[np.float64], *shape: int | None, least: int = 0) -> None:
    """Raise `LocomotionError` unless ``values`` are finite float64 of this ``shape`` (None: any size), with
    at least ``least`` rows."""
    fits = values.ndim == len(shape) and all(
        want in (None, size) for size, want in zip(values.shape, shape, strict=True)
    )
    if not fits or values.dtype != np.float64 or len(values) < least:
        wanted = ", ".join("n" if size is None else str(size) for size in shape)
        raise LocomotionError(f"{what} has shape {values.shape}, expected ({wanted}) float64")
    if values.size and not (values.min() >= -FARTHEST and values.max() <= FARTHEST):
        raise LocomotionError(f"{what} holds numbers that are not finite, or too great")
