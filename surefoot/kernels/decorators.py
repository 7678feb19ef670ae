"""Numba's decorators, with a cache of our own."""

from collections.abc import Callable
from typing import Any

import numba
from numba import types
from numba.core.ccallback import CFunc
from numba.core.dispatcher import Dispatcher
from numba.core.sigutils import normalize_signature

from surefoot.kernels.cache import KernelCache

__all__ = ["allocating_kernel", "cfunc", "kernel"]


def kernel(function: Callable | None = None, **options: Any) -> Any:
    """Compiles a function that makes no arrays, as ``@kernel`` or ``@kernel(error_model="numpy")``; options
    as of `numba.njit`. The compiled code is kept in the user's cache folder.

    Numba counts references to arrays wherever a function takes one or looks one up in a bundle, with an
    atomic operation each time: half of the time of many kernels, and of the time to compile them. A function
    that only reads and writes arrays that it is given needs no counting. It must not return an array, nor
    call what returns a new one. Numba refuses to compile one that makes an array itself.
    """
    return _kernel(function, {**options, "_nrt": False})


def allocating_kernel(function: Callable | None = None, **options: Any) -> Any:
    """Compiles a function that makes, copies or returns arrays, like `kernel`."""
    return _kernel(function, {**options, "_nrt": True})


def _kernel(function: Callable | None, options: dict[str, Any]) -> Any:
    def decorate(function: Callable) -> Any:
        made = numba.njit(**options)(function)
        if isinstance(made, Dispatcher):  # not with NUMBA_DISABLE_JIT
            made._cache = KernelCache(function, options, made)
            _compile_less(made)
        return made

    return decorate if function is None else decorate(function)


def _compile_less(made: Dispatcher) -> None:
    """Let kernels that call ``made`` with constants and short integers share the code for int64.

    Numba would compile it for each constant that it meets, and for what the type of a variable seems to be
    before it has seen all that is assigned to it; most of that is never called.
    """
    template = made.get_call_template

    def shared(args: Any, kws: Any) -> Any:
        named = {name: _widened(kind) for name, kind in dict(kws).items()}
        return template(tuple(map(_widened, args)), named)

    made.get_call_template = shared  # type: ignore[method-assign]


def _widened(kind: types.Type) -> types.Type:
    kind = types.unliteral(kind)
    return types.int64 if isinstance(kind, types.Integer) and kind.signed and kind.bitwidth < 64 else kind


def cfunc(signature: Any) -> Any:
    """`numba.cfunc` of a signature, compiled code kept as that of `kernel`."""

    def decorate(function: Callable) -> Any:
        options = {"nopython": True}
        made = CFunc(function, normalize_signature(signature), locals={}, options=options)
        made._cache = KernelCache(function, {"cfunc": True})  # type: ignore[attr-defined]
        made.compile()
        return made

    return decorate
