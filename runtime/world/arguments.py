"""Numbers and files that a host passes, checked."""

import math
import os
from collections.abc import Iterable
from numbers import Real
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from runtime.errors import RuntimeInputError
from surefoot.numeric import as_floats, is_whole

__all__ = ["checked_files", "checked_number", "checked_points", "checked_whole"]


def checked_number(value: object, what: str, unit: str, least: float = -math.inf) -> float:
    """``value`` as a float; `RuntimeInputError` unless it is a finite number of at least ``least``."""
    if isinstance(value, bool) or not isinstance(value, Real) or not math.isfinite(value) or value < least:
        bound = "" if least == -math.inf else f" of at least {least:g}"
        raise RuntimeInputError(f"{what} must be a finite number{bound} [{unit}], not {value!r}")
    return float(value)


def checked_points(points: ArrayLike, what: str) -> NDArray[np.float64]:
    """``points`` as (k, 3) float64; `RuntimeInputError` unless they are finite numbers (3,) or (k, 3)."""
    checked = as_floats(points)
    if (
        checked is None
        or checked.ndim not in (1, 2)
        or checked.shape[-1] != 3
        or not checked.size
        or not np.isfinite(checked).all()
    ):
        raise RuntimeInputError(f"{what} must be finite numbers (3,) or (k, 3) [m], not {points!r}")
    return checked.reshape(-1, 3)


def checked_whole(value: Any, what: str, least: int = 0) -> int:
    """``value`` as an int; `RuntimeInputError` unless it is a whole number of at least ``least``."""
    if not (is_whole(value) and value >= least):
        raise RuntimeInputError(f"{what} must be a whole number of at least {least}, not {value!r}")
    return int(value)


def checked_files(files: Any, what: str) -> tuple[Path, ...]:
    """``files`` as absolute paths; `RuntimeInputError` unless they are several, each a text or a path."""
    if isinstance(files, str | bytes | os.PathLike) or not isinstance(files, Iterable):
        raise RuntimeInputError(f"{what} must be a list of files, not {files!r}")
    paths = tuple(files)
    for each in paths:
        if not isinstance(each, str | os.PathLike):
            raise RuntimeInputError(f"{what} must be a list of files; {each!r} is none")
    return tuple(Path(each).resolve() for each in paths)
