"""Check that a caller's values are numbers, at the edge of the public API."""

import math
from numbers import Integral
from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["as_floats", "as_point", "is_finite", "is_whole"]


def is_finite(value: Any) -> bool:
    """Whether ``value`` is one finite number."""
    try:
        return math.isfinite(value)
    except (TypeError, ValueError, OverflowError):
        return False


def is_whole(value: Any) -> bool:
    """Whether ``value`` is a whole number of at least 0."""
    return isinstance(value, Integral) and not isinstance(value, bool) and int(value) >= 0


def as_floats(value: Any) -> NDArray[np.float64] | None:
    """``value`` as a float64 array of any shape, finite or not; None if it holds anything but numbers, or
    rows of different lengths."""
    try:
        array = np.asarray(value)
        return None if array.dtype.kind in "USc" else array.astype(np.float64)
    except (TypeError, ValueError, OverflowError):
        return None


def as_point(value: Any) -> NDArray[np.float64] | None:
    """``value`` as a float64 array (3,); None if it is anything but three finite numbers."""
    array = as_floats(value)
    return array if array is not None and array.shape == (3,) and np.isfinite(array).all() else None
