"""What a kernel's compiled code depends on: its own code, the kernels it calls, and the constants and types
it uses."""

import hashlib
import importlib
import types as python_types
from collections.abc import Callable, Iterator
from enum import Enum
from functools import cache
from numbers import Number
from pathlib import Path
from typing import Any

import numpy as np
from numba import types
from numba.core.dispatcher import Dispatcher

__all__ = ["PACKAGES", "digest_of_code", "digest_of_type", "is_ours"]

PACKAGES = ("navmesh", "pathsmooth", "locomotion", "runtime")
"""The packages that have kernels."""


@cache
def digest_of_code(function: Callable) -> str:
    """Hex digest of a Python function and everything it uses: equal digests, equal kernels.

    Comments, line numbers and other code in its file do not count.
    """
    checksum = hashlib.sha256()
    seen, waiting = {function}, [function]
    while waiting:
        here = waiting.pop(0)
        for part in _parts(here):
            if isinstance(part, Dispatcher):
                called = part.py_func
                checksum.update(f"{called.__module__}.{called.__qualname__} {_options(part)}\0".encode())
                if called not in seen:
                    seen.add(called)
                    waiting.append(called)
            else:
                checksum.update(f"{part}\0".encode())
    return checksum.hexdigest()


def _options(kernel: Dispatcher) -> str:
    return repr(sorted(kernel.targetoptions.items()))


def _parts(function: Any) -> Iterator[Any]:
    """The parts of one function as text, and the kernels that it uses, in order."""
    cells = [cell.cell_contents for cell in function.__closure__ or ()]
    for value in (function.__defaults__, cells):
        yield from _value(value, function, ())
    codes = [function.__code__]
    while codes:
        code = codes.pop(0)
        yield f"{code.co_name} {code.co_argcount} {code.co_flags} {code.co_names} {code.co_varnames}"
        yield f"{code.co_freevars} {code.co_cellvars} {code.co_code.hex()}"
        for constant in code.co_consts:
            if isinstance(constant, python_types.CodeType):
                codes.append(constant)
            else:
                yield repr(sorted(constant, key=repr) if isinstance(constant, frozenset) else constant)
        for name in code.co_names:
            if name in function.__globals__:
                yield name
                yield from _value(function.__globals__[name], function, code.co_names)


def _value(value: Any, user: Any, names: tuple[str, ...]) -> Iterator[Any]:
    """Parts of a value that ``user`` refers to; of our own modules, their attributes among ``names``."""
    if isinstance(value, Dispatcher):
        yield value
    elif value is None or isinstance(value, Enum | Number | str | bytes):
        yield f"{type(value).__name__} {value!r}"
    elif isinstance(value, np.ndarray):
        yield f"{value.dtype} {value.shape} {value.tobytes().hex()}"
    elif isinstance(value, tuple | list):
        yield f"{type(value).__name__} {len(value)}"
        for each in value:
            yield from _value(each, user, names)
    elif isinstance(value, python_types.ModuleType):
        yield value.__name__
        if is_ours(value.__name__):
            for name in names:
                if hasattr(value, name):
                    yield from _value(getattr(value, name), user, names)
    elif isinstance(value, types.Type):
        yield digest_of_type(value)
    elif hasattr(value, "_fields") and isinstance(value, type):
        yield f"{value.__module__}.{value.__qualname__} {value._fields}"
    else:
        module = getattr(value, "__module__", None) or type(value).__module__
        yield f"{module}.{getattr(value, '__qualname__', type(value).__qualname__)}"
        # a Numba extension: its whole file counts if it is ours, else the user's whole file
        defined = getattr(getattr(value, "_defn", value), "__module__", None)
        if not isinstance(defined, str):
            yield _digest_of_file(user.__module__)
        elif is_ours(defined):
            yield _digest_of_file(defined)


@cache
def digest_of_type(kind: types.Type) -> str:
    """Text that identifies a Numba type, including the version of its class."""
    parts = [str(kind)]
    for each in getattr(kind, "types", ()):
        parts.append(digest_of_type(each))
    made = getattr(kind, "instance_class", None)
    if made is not None:
        parts.append(f"{made.__module__}.{made.__qualname__} {getattr(made, '_fields', '')}")
    if is_ours(type(kind).__module__):
        parts.append(_digest_of_file(type(kind).__module__))
    return " ".join(parts)


def is_ours(module: str) -> bool:
    """Whether a module is one of the packages that have kernels."""
    return module.partition(".")[0] in PACKAGES


@cache
def _digest_of_file(module: str) -> str:
    file = importlib.import_module(module).__file__
    return hashlib.sha256(Path(file).read_bytes() if file else b"").hexdigest()
