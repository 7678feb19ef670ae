"""Let Numba compile in less time what it compiles anyway; the code does the same to the bit.

- Numba looks up overloads by their options, and compares options attribute by attribute, defaults included.
  Comparing what is set is enough.
- It optimises each function by itself, then twice in its module. Only the latter counts.
- For each operation on two numbers, and for each element of an array, it asks all that could know its types,
  in the same order with the same answer. The answer is remembered.
- It compiles a function of NumPy once for each set of the caller's options. Only four of them go over to it.
- Assigning an array to a slice compiles, into each kernel that does so, code that puts both shapes into a
  message in case they differ. A fixed message takes a tenth of the time.

This reaches into Numba, and is done only for versions in which it was tried.
"""

import operator
from typing import Any

import numba
from numba import types
from numba.core.codegen import CPUCodeLibrary
from numba.core.targetconfig import ConfigStack, TargetConfig
from numba.core.types.functions import BaseFunction
from numba.core.typing.templates import _OverloadFunctionTemplate
from numba.extending import overload
from numba.np import arrayobj

__all__ = ["compile_faster", "is_tried"]

_TRIED = ((0, 68),)
"""Versions of Numba whose internals this was tested with."""
_hashes: dict[type, int] = {}
_resolve = BaseFunction.get_call_type


def is_tried() -> bool:
    """Whether Numba is of a version whose internals are as they were when this was tested."""
    return tuple(int(part) for part in numba.__version__.split(".")[:2]) in _TRIED


def compile_faster() -> None:
    """Change Numba, in this process."""
    if is_tried():
        TargetConfig.__eq__ = _are_equal  # type: ignore[method-assign]
        TargetConfig.__hash__ = _hash_of_kind  # type: ignore[method-assign]
        CPUCodeLibrary._optimize_functions = _leave_to_module  # type: ignore[method-assign]
        BaseFunction.get_call_type = _remembered  # type: ignore[method-assign]
        _OverloadFunctionTemplate._get_impl = _for_inherited_options  # type: ignore[method-assign]
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


def _remembered(function: Any, context: Any, args: tuple, kws: Any) -> Any:
    """The signature of an operator for plain types. Where more of them are registered, Numba makes another
    ``function``: what this one knows does not change."""
    if kws or not _are_plain(function.typing_key, args):
        return _resolve(function, context, args, kws)
    known = function.__dict__.setdefault("_remembered", {})
    signature = known.get(args)
    if signature is None:
        signature = known[args] = _resolve(function, context, args, kws)
    return signature


def _are_plain(operation: Any, args: tuple) -> bool:
    """Whether it is one of two numbers, or of an array's element: not a compiled function with options."""
    first = 0
    if operation in (operator.getitem, operator.setitem) and isinstance(args[0], types.Array):
        first = 1
    elif getattr(operation, "__module__", None) != "_operator":
        return False
    return all(map(_is_number, args[first:]))


def _is_number(kind: types.Type) -> bool:
    if isinstance(kind, types.BaseTuple):
        return all(isinstance(each, types.Integer) for each in kind)
    return isinstance(kind, types.Number | types.Boolean)


def _for_inherited_options(template: Any, args: tuple, kws: Any) -> Any:
    """As Numba's own `_get_impl`, whose key has all options of the caller. These go over, see
    `CPUTargetOptions.finalize`."""
    flags = ConfigStack.top_or_none()
    inherited = flags and (flags.nrt, str(flags.fastmath.flags), flags.error_model, flags.forceinline)
    key = template.context, tuple(args), tuple(kws.items()), inherited
    if key not in template._impl_cache:
        return template._build_impl(key, args, kws)
    return template._impl_cache[key]


def _refuse_shape(source: tuple[int, ...], slice: tuple[int, ...]) -> None:
    """Raises `ValueError`: an array does not have the shape of the slice that it is assigned to."""
    raise NotImplementedError  # compiled as below


@overload(_refuse_shape)
def _compiled_refusal(source: Any, slice: Any) -> Any:
    def refuse(source: Any, slice: Any) -> None:
        raise ValueError("cannot assign slice from input of different size")

    return refuse
