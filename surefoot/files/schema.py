"""What an archive holds: names, types, shapes and ranges of its arrays, and the fields of its header.

A kind of file is one `Schema`. To add an array to a kind, add a line to its schema::

    "edge_target": Indices("edges", into="nodes"),

An array's sizes are numbers or names; the same name means the same size in all arrays, and "nodes+1" is one
more than "nodes". `surefoot.files.archive` checks types and shapes before it unpacks anything, then the
values.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Generic, TypeVar

import numpy as np
from pydantic import BaseModel, ConfigDict

__all__ = ["Array", "Flags", "Header", "Indices", "Numbers", "Offsets", "Rising", "Schema", "Sizes", "Words"]

Size = int | str
_FARTHEST = 1e9  # [m] largest coordinate of a level, and largest number in a file


class Header(BaseModel):
    """Fields of an archive's header besides its kind and version: no others, strictly typed."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True, allow_inf_nan=False)


HeaderType = TypeVar("HeaderType", bound=Header)


class Sizes:
    """Named sizes, each set by the first array that uses its name."""

    def __init__(self) -> None:
        self._known: dict[str, tuple[int, str]] = {}

    def __getitem__(self, name: str) -> int:
        return self._known[name][0]

    def problem(self, array: str, shape: tuple[int, ...], wanted: tuple[Size, ...]) -> str | None:
        """Why ``array``'s ``shape`` does not match ``wanted``; None if it does."""
        if len(shape) != len(wanted):
            return f"{array} has {len(shape)} axes, expected {len(wanted)}"
        for axis, (size, want) in enumerate(zip(shape, wanted, strict=True)):
            if isinstance(want, int):
                if size != want:
                    return f"{array} has shape {shape}, expected {want} on axis {axis}"
                continue
            name, _, more = want.partition("+")
            count = size - int(more or 0)
            known, said_by = self._known.setdefault(name, (count, array))
            if count < 0 or count != known:
                return f"{array} has shape {shape}, which does not fit {known} {name} (as in {said_by})"
        return None


@dataclass(frozen=True)
class Array:
    """An array of ``dtype`` with any values."""

    dtype: str
    shape: tuple[Size, ...]

    def accepts(self, dtype: np.dtype) -> bool:
        """Whether the array may be of this type."""
        return dtype == np.dtype(self.dtype)

    def problem(self, name: str, values: np.ndarray, sizes: Sizes) -> str | None:
        """What is wrong with ``values`` of the right type and shape; None if nothing."""
        return None


@dataclass(frozen=True, init=False)
class Flags(Array):
    """True or false."""

    def __init__(self, *shape: Size) -> None:
        super().__init__("bool", shape)

    def problem(self, name: str, values: np.ndarray, sizes: Sizes) -> str | None:
        # a flag is a byte in the file, and compiled code might use any value of it as a number
        return _out_of(name, values.view(np.uint8), 0, 1)


@dataclass(frozen=True, init=False)
class Numbers(Array):
    """Finite numbers from ``low`` to ``high``."""

    low: float
    high: float

    def __init__(
        self, *shape: Size, low: float = -_FARTHEST, high: float = _FARTHEST, dtype: str = "float64"
    ) -> None:
        super().__init__(dtype, shape)
        object.__setattr__(self, "low", low)
        object.__setattr__(self, "high", high)

    def problem(self, name: str, values: np.ndarray, sizes: Sizes) -> str | None:
        return _out_of(name, values, self.low, self.high)


class Rising(Numbers):
    """Like `Numbers`, but each greater than the one before along one axis; at least ``least`` of them."""

    least: int

    def __init__(self, size: Size, least: int = 1, low: float = -_FARTHEST, high: float = _FARTHEST) -> None:
        super().__init__(size, low=low, high=high)
        object.__setattr__(self, "least", least)

    def problem(self, name: str, values: np.ndarray, sizes: Sizes) -> str | None:
        if len(values) < self.least:
            return f"{name} has {len(values)} rows, expected at least {self.least}"
        falls = values[1:] <= values[:-1]
        if falls.any():
            return f"{name} does not increase after {int(np.argmax(falls))}"
        return super().problem(name, values, sizes)


@dataclass(frozen=True, init=False)
class Indices(Array):
    """Row indices of arrays with ``into`` rows; ``none``: -1 means no row."""

    into: Size
    none: bool

    def __init__(self, *shape: Size, into: Size, none: bool = False, dtype: str = "int32") -> None:
        super().__init__(dtype, shape)
        object.__setattr__(self, "into", into)
        object.__setattr__(self, "none", none)

    def problem(self, name: str, values: np.ndarray, sizes: Sizes) -> str | None:
        count = self.into if isinstance(self.into, int) else sizes[self.into]
        return _out_of(name, values, -1 if self.none else 0, count - 1)


@dataclass(frozen=True, init=False)
class Offsets(Array):
    """(count + 1,): row i owns the ``into`` rows from offset i up to offset i + 1."""

    into: str

    def __init__(self, count: Size, into: str) -> None:
        super().__init__("int32", (count + 1 if isinstance(count, int) else f"{count}+1",))
        object.__setattr__(self, "into", into)

    def problem(self, name: str, values: np.ndarray, sizes: Sizes) -> str | None:
        if values[0] != 0 or values[-1] != sizes[self.into]:
            return f"{name} goes from {values[0]} to {values[-1]}, expected 0 to {sizes[self.into]}"
        falls = values[1:] < values[:-1]
        return f"{name} decreases after {int(np.argmax(falls))}" if falls.any() else None


@dataclass(frozen=True, init=False)
class Words(Array):
    """Texts of at most ``longest`` characters; with ``among`` only those it returns when a file is read."""

    longest: int
    among: Callable[[], Sequence[str]] | None

    def __init__(
        self, *shape: Size, longest: int = 64, among: Callable[[], Sequence[str]] | None = None
    ) -> None:
        super().__init__("str", shape)
        object.__setattr__(self, "longest", longest)
        object.__setattr__(self, "among", among)

    def accepts(self, dtype: np.dtype) -> bool:
        return dtype.kind == "U" and dtype.isnative and dtype.itemsize <= 4 * self.longest

    def problem(self, name: str, values: np.ndarray, sizes: Sizes) -> str | None:
        codes = np.ascontiguousarray(values).reshape(-1).view(np.uint32)
        if (codes > 0x10FFFF).any() or ((codes >= 0xD800) & (codes <= 0xDFFF)).any():
            return f"{name} holds values that are not text"
        if self.among is not None:
            known = np.isin(values, list(self.among()))
            if not known.all():
                return f"{name} holds {str(values[~known][0])!r}, expected {', '.join(self.among())}"
        return None


def _out_of(name: str, values: np.ndarray, low: float, high: float) -> str | None:
    """Finds least and greatest without a copy; NaN counts as out of range."""
    if values.size == 0 or (values.min() >= low and values.max() <= high):
        return None
    at = np.unravel_index(int(np.argmin((values >= low) & (values <= high))), values.shape)
    where = ", ".join(str(int(index)) for index in at)
    where = f"[{where}]" if where else ""
    number = "a finite number from " if values.dtype.kind == "f" else ""
    return f"{name}{where} is {values[at]}, expected {number}{low:.12g} to {high:.12g}"


@dataclass(frozen=True)
class Schema(Generic[HeaderType]):
    """A kind of archive.

    ``kind`` and ``version``: as in its header. ``arrays``: its arrays by name; they may depend on the header.
    ``check``: what else is wrong with a header's arrays, as a sentence; None if nothing. ``remedy``: what a
    user does about an unreadable file, such as "bake it again".
    """

    kind: str
    version: int
    header: type[HeaderType]
    arrays: Mapping[str, Array] | Callable[[HeaderType], Mapping[str, Array]]
    remedy: str
    check: Callable[[HeaderType, dict[str, np.ndarray]], str | None] = field(
        default=lambda header, arrays: None
    )

    def arrays_of(self, header: Any) -> Mapping[str, Array]:
        """The arrays of a file with this ``header``."""
        return self.arrays(header) if callable(self.arrays) else self.arrays
