"""Check that the fields of a saved record have the types that its class declares."""

import math
import sys
import types
from collections.abc import Mapping
from functools import lru_cache
from typing import Annotated, Any, Literal, Union, get_args, get_origin, get_type_hints

import numpy as np

__all__ = ["wrong_field"]

_MOST = sys.float_info.max


def wrong_field(record: Any) -> str | None:
    """Name of the first field of a dataclass or named tuple with a wrong type; None if all are right."""
    for name, kind in _types_of(type(record)).items():
        if not _is(getattr(record, name), kind):
            return name
    return None


@lru_cache(maxsize=256)
def _types_of(record: type) -> dict[str, Any]:
    return get_type_hints(record)


def _is(value: Any, kind: Any) -> bool:
    """Whether ``value`` has type ``kind``, one of those used in saved states."""
    origin, inner = get_origin(kind), get_args(kind)
    if kind is Any or getattr(kind, "_is_protocol", False):
        return True
    if origin in (Union, types.UnionType):
        return any(_is(value, each) for each in inner)
    if origin is Annotated:
        return _is(value, inner[0])
    if origin is Literal:
        return any(type(value) is type(each) and value == each for each in inner)
    if origin is tuple:
        if not isinstance(value, tuple):
            return False
        if inner[-1:] == (Ellipsis,):
            return all(_is(each, inner[0]) for each in value)
        return len(value) == len(inner) and all(map(_is, value, inner))
    if origin in (dict, Mapping):
        return isinstance(value, dict) and all(
            _is(key, inner[0]) and _is(each, inner[1]) for key, each in value.items()
        )
    if kind is np.ndarray or origin is np.ndarray:
        return isinstance(value, np.ndarray) and value.dtype == np.float64
    if kind is float:
        # integers in text can be too large to convert
        return not math.isnan(value) if type(value) is float else type(value) is int and abs(value) <= _MOST
    if kind is None:
        return value is None
    return type(value) is kind if kind in (int, bool, str) else isinstance(value, kind)
