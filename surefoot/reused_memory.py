"""Large arrays in memory that others have had before: the system clears what it gives anew, page by page,
which takes longer than filling it.

For arrays of which one version after the other is made, each as large as the one before, such as those of a
level's cells when it is updated. Memory whose arrays are gone waits for the next ones; never more of it than
such arrays have that are in use.
"""

import math
import threading
from typing import Any

import numpy as np

__all__ = ["empty"]

_LEAST = 1 << 20  # [bytes] smaller arrays are not worth it
_STEP = 1.0625  # sizes are rounded up by up to this factor: so arrays that differ a little can take turns
_LOCK = threading.RLock()  # arrays can go at any time, also while one is being made
_waiting: dict[int, list[np.ndarray]] = {}
_bytes = {"in use": 0, "waiting": 0}


class _Loan:
    """What an array's memory belongs to: gives it back when nothing uses it any longer."""

    def __init__(self, memory: np.ndarray, shape: tuple[int, ...], dtype: np.dtype) -> None:
        self.memory = memory
        self.__array_interface__ = {
            "data": (memory.ctypes.data, False), "shape": shape, "typestr": dtype.str, "version": 3,
        }  # fmt: skip
        with _LOCK:
            _bytes["in use"] += memory.nbytes

    def __del__(self) -> None:
        size = self.memory.nbytes
        with _LOCK:
            _bytes["in use"] -= size
            _waiting.setdefault(size, []).append(self.memory)
            _bytes["waiting"] += size
            while _bytes["waiting"] > _bytes["in use"]:
                other = next(iter(_waiting))
                _bytes["waiting"] -= other * len(_waiting.pop(other))


def empty(shape: int | tuple[int, ...], dtype: Any = np.float64) -> np.ndarray:
    """An array (``shape``) of numbers, as `numpy.empty` makes it."""
    dtype, extents = np.dtype(dtype), (shape,) if isinstance(shape, int) else shape
    size = math.prod(extents) * dtype.itemsize
    if size < _LEAST:
        return np.empty(shape, dtype)
    size = math.ceil(_STEP ** math.ceil(math.log(size, _STEP)))
    with _LOCK:
        others = _waiting.get(size)
        memory = others.pop() if others else None
        if memory is not None:
            _bytes["waiting"] -= size
    return np.asarray(_Loan(np.empty(size, np.uint8) if memory is None else memory, extents, dtype))
