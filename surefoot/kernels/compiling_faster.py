"""Let Numba compile in less time what it compiles anyway; the code does the same to the bit.

- Numba looks up overloads by their options, and compares options attribute by attribute, defaults included.
  Comparing what is set is enough.
- It optimises each function by itself, then twice in its module. Only the latter counts.
- Assigning an array to a slice compiles, into each kernel that does so, code that puts both shapes into a
  message in case they differ. A fixed message takes a tenth of the time.

This reaches into Numba, and is done only for versions in which it was tried.
"""

from typing import Any

import numba
from numba.core.codegen import CPUCodeLibrary
from numba.core.targetconfig import TargetConfig
from numba.extending import overload
from numba.np import arrayobj

__all__ = ["compile_faster", "is_tried"]

_TRIED = ((0, 68),)
"""Versions of Numba whose internals this was tested with."""
_hashes: dict[type, int] = {}


def is_tried() -> bool:
    """Whether Numba is of a version whose internals are as they were when this was tested."""
    return tuple(int(part) for part in numba.__version__.split(".")[:2]) in _TRIED


def compile_faster() -> None:
    """Change Numba, in this process."""
    if is_tried():
        TargetConfig.__eq__ = _are_equal  # type: ignore[method-assign]
        TargetConfig.__hash__ = _hash_of_kind  # type: ignore[method-assign]
        CPUCodeLibrary._optimize_functions = _leave_to_module  # type: ignore[method-assign]
        arrayobj.raise_with_shape_context = _refuse_shape


def _are_equal(one: TargetConfig, other: object) -> Any:
    if one is other:
        return True
    if not isinstance(other, TargetConfig):
        return NotImplemented
    if type(one) is not type(other):
        return one.values() == other.values()
    ours, theirs = one._values, other._values
    if ours == theirs:
        return True
    options = one.options
    for name in ours.keys() | theirs.keys():
        default = options[name].default
        if ours.get(name, default) != theirs.get(name, default):
            return False
    return True


def _hash_of_kind(one: TargetConfig) -> int:
    """As Numba's own, which is that of the names of all options."""
    kind = type(one)
    if kind not in _hashes:
        _hashes[kind] = hash(tuple(sorted(one.options)))
    return _hashes[kind]


def _leave_to_module(library: CPUCodeLibrary, module: Any) -> None:
    module.data_layout = library._codegen._data_layout


def _refuse_shape(source: tuple[int, ...], slice: tuple[int, ...]) -> None:
    """Raises `ValueError`: an array does not have the shape of the slice that it is assigned to."""
    raise NotImplementedError  # compiled as below


@overload(_refuse_shape)
def _compiled_refusal(source: Any, slice: Any) -> Any:
    def refuse(source: Any, slice: Any) -> None:
        raise ValueError("cannot assign slice from input of different size")

    return refuse
