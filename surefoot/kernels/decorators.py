"""Numba's decorators with a cache of our own."""

from collections.abc import Callable
from typing import Any

import numba
from numba import types
from numba.core.ccallback import CFunc
from numba.core.dispatcher import Dispatcher
from numba.core.sigutils import normalize_signature

from surefoot.kernels.cache import KernelCache
from surefoot.kernels.compiling_faster import compile_faster

__all__ = ["allocating_kernel", "cfunc", "kernel"]

compile_faster()


def kernel(function: Callable | None = None, **options: Any) -> Any:
    """Compile a function that creates no arrays: ``@kernel`` or ``@kernel(error_model="numpy")``, with
    options of `numba.njit`. The compiled code is kept in the user's cache folder.

    Numba counts references to arrays wherever a function takes one or looks one up, with an atomic operation
    each time; that took half the run time, and compile time, of many kernels. A function that only reads and
    writes arrays it is given needs no counting. It must not return an array or call a function that returns a
    new one. Numba refuses to compile one that creates an array itself.
    """
    return _kernel(function, {**options, "_nrt": False})


def allocating_kernel(function: Callable | None = None, **options: Any) -> Any:
    """Like `kernel`, for functions that create, copy or return arrays."""
    return _kernel(function, {**options, "_nrt": True})


def _kernel(function: Callable | None, options: dict[str, Any]) -> Any:
    options["no_cfunc_wrapper"] = True  # nobody takes the address of a kernel
    options.setdefault("forceinline", False)  # Numba would take it over from the first caller

    def decorate(function: Callable) -> Any:
        made = numba.njit(**options)(function)
        if isinstance(made, Dispatcher):  # if NUMBA_DISABLE_JIT is set
            made._cache = KernelCache(function, options, made)
            _compile_less(made)
        return made

    return decorate if function is None else decorate(function)


def _compile_less(made: Dispatcher) -> None:
    """Let kernels that call ``made`` with constants and short integers share the code for int64.

    Otherwise Numba compiles a version for each constant, and for each provisional type of a variable during
    type inference; most of these are never called.
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
    """`numba.cfunc` of a signature, cached like `kernel`."""

    def decorate(function: Callable) -> Any:
        options = {"nopython": True}
        made = CFunc(function, normalize_signature(signature), locals={}, options=options)
        made._cache = KernelCache(function, {"cfunc": True})  # type: ignore[attr-defined]
        made.compile()
        return made

    return decorate
