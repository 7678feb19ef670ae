"""Checks of the arrays in a saved body: their shapes, and the range of each number."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from locomotion.errors import LocomotionError

__all__ = ["COUNT", "FARTHEST", "FLAG", "SIDE", "Slots", "check_array", "check_number"]

FARTHEST = 1e9
"""Largest number that a saved array may hold; no coordinate [m] is farther from the origin."""
COUNT, FLAG, SIDE = (0.0, FARTHEST), (0.0, 1.0), (-1.0, 1.0)
"""Ranges of a count, of a flag (0 or 1), and of a side (1 left, -1 right)."""
Slot = int | slice


class Slots:
    """What the numbers of a saved array may be.

    ``what``: name of the array in errors. ``size``: count of its numbers. ``ranges``: least and greatest
    value of some of them; the others need only be finite. ``whole``: those that must be whole numbers.
    ``open_ended``: those that may also be infinite or NaN.
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
        """Raise `LocomotionError` if ``values`` is not a valid ``what``; the message names the number."""
        if values.shape != (self.size,) or values.dtype != np.float64:
            raise LocomotionError(f"{_described(self.what, values)}, expected ({self.size},) float64")
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
    """Raise `LocomotionError` if ``value`` is NaN or not from ``low`` to ``high``."""
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
        rows = f" with n from {least} on" if least else ""
        raise LocomotionError(f"{_described(what, values)}, expected ({wanted}) float64{rows}")
    if values.size and not (values.min() >= -FARTHEST and values.max() <= FARTHEST):
        raise LocomotionError(f"{what} holds numbers that are not finite, or too great")


def _described(what: str, values: NDArray[Any]) -> str:
    return f"{what} is an array of shape {values.shape} and type {values.dtype}"
