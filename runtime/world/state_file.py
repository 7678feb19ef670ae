"""Saved states as files: a tree of records, plain values and arrays, to the last bit.

The tree goes into the JSON header of an archive, the numbers of its arrays behind one another into one array
for each dtype. A record, which is a frozen dataclass or named tuple of this distribution, is written by its
full name and made again from its fields.
"""

import dataclasses
import math
import sys
from collections.abc import Mapping
from typing import Any

import numpy as np

from runtime.errors import RuntimeInputError
from surefoot.files.record_types import wrong_field

__all__ = ["DTYPES", "pack", "unpack"]

DTYPES = ("float64", "float32", "int64", "int32", "bool")
"""Types of the arrays of a state."""

_WRONG = (
    KeyError, TypeError, ValueError, IndexError, AttributeError, OverflowError, RecursionError,
)  # fmt: skip
_NOT_FINITE = {"nan": math.nan, "inf": math.inf, "-inf": -math.inf}
_PACKAGES = ("navmesh.", "pathsmooth.", "locomotion.", "runtime.")


def pack(value: Any) -> tuple[Any, dict[str, np.ndarray]]:
    """``value`` as a tree that JSON can represent, and the arrays that `unpack` needs with it.

    Raises `RuntimeInputError` for what is neither a record of this distribution nor an array, a tuple, a
    list, a mapping with text for keys, or a plain value.
    """
    packer = _Packer()
    tree = packer.tree(value)
    return tree, {dtype: np.concatenate([np.empty(0, dtype), *packer.parts[dtype]]) for dtype in DTYPES}


def unpack(tree: Any, arrays: Mapping[str, np.ndarray]) -> Any:
    """What was given to `pack`. Raises `RuntimeInputError` for a tree that is not from there, or from
    another release."""
    try:
        return _Unpacker(arrays).value(tree)
    except _WRONG as error:
        raise RuntimeInputError(f"the state is damaged or of another release: {error}") from None


class _Packer:
    def __init__(self) -> None:
        self.parts: dict[str, list[np.ndarray]] = {dtype: [] for dtype in DTYPES}
        self._used: dict[str, int] = {}
        self._known: dict[int, tuple[np.ndarray, Any]] = {}

    def tree(self, value: Any) -> Any:
        if isinstance(value, float) and not math.isfinite(value):
            return {"float": repr(float(value))}  # JSON has none of these
        if value is None or isinstance(value, bool | int | float | str):
            return value
        if isinstance(value, np.ndarray) and value.dtype.name in DTYPES:
            return {"array": self._array(value)}
        if (names := _fields(type(value))) is not None:
            fields = {name: self.tree(getattr(value, name)) for name in names}
            return {"class": f"{type(value).__module__}:{type(value).__qualname__}", "fields": fields}
        if isinstance(value, tuple):
            return {"tuple": [self.tree(each) for each in value]}
        if isinstance(value, list):
            return [self.tree(each) for each in value]
        if isinstance(value, Mapping):
            return {"dict": [[_text(key), self.tree(each)] for key, each in value.items()]}
        raise RuntimeInputError(f"a state file cannot hold a {type(value).__module__}.{type(value).__name__}")

    def _array(self, array: np.ndarray) -> Any:
        if id(array) not in self._known:
            dtype = array.dtype.name
            start = self._used.get(dtype, 0)
            self.parts[dtype].append(array.ravel())
            self._used[dtype] = start + array.size
            self._known[id(array)] = array, [dtype, start, list(array.shape)]
        return self._known[id(array)][1]


def _text(key: Any) -> str:
    if not isinstance(key, str):
        raise RuntimeInputError(f"a state file cannot hold the key {key!r}: keys must be text")
    return key


def _fields(kind: Any) -> tuple[str, ...] | None:
    """Names of the fields of a record of this distribution; None for what is none."""
    if not f"{kind.__module__}.".startswith(_PACKAGES):
        return None
    if dataclasses.is_dataclass(kind):
        frozen = kind.__dataclass_params__.frozen  # type: ignore[attr-defined]
        return tuple(each.name for each in dataclasses.fields(kind)) if frozen else None
    return getattr(kind, "_fields", None)


class _Unpacker:
    """Reads the tree. Arrays that were one when they were packed are one again, and no others overlap, so
    that a small file cannot become a large state."""

    def __init__(self, arrays: Mapping[str, np.ndarray]) -> None:
        self._arrays = arrays
        self._left = {dtype: len(array) for dtype, array in arrays.items()}
        self._known: dict[tuple[str, int, tuple[int, ...]], np.ndarray] = {}

    def value(self, tree: Any) -> Any:
        if isinstance(tree, list):
            return [self.value(each) for each in tree]
        if not isinstance(tree, dict):
            return tree
        if "float" in tree:
            return _NOT_FINITE[tree["float"]]
        if "array" in tree:
            return self._array(*tree["array"])
        if "tuple" in tree:
            return tuple(self.value(each) for each in tree["tuple"])
        if "dict" in tree:
            return {_text(key): self.value(each) for key, each in tree["dict"]}
        module, _, name = tree["class"].partition(":")
        kind = getattr(sys.modules[module], name)
        if _fields(kind) is None:
            raise TypeError(f"{tree['class']} is not part of a state")
        record = kind(**{key: self.value(each) for key, each in tree["fields"].items()})
        if (field := wrong_field(record)) is not None:
            raise TypeError(f"{name}.{field} is of a wrong type")
        return record

    def _array(self, dtype: str, start: int, shape: list[int]) -> np.ndarray:
        key = dtype, start, tuple(shape)
        if key not in self._known:
            size = math.prod(shape)
            self._left[dtype] -= size
            if self._left[dtype] < 0 or min(start, *shape, 0) < 0:
                raise ValueError(f"an array of shape {shape} is more than there is")
            self._known[key] = self._arrays[dtype][start : start + size].reshape(shape).copy()
        return self._known[key]
