"""Compile large kernels once and call them, instead of copying them into their callers.

Numba copies a function's code into the module of each caller, with everything that it calls, and optimises
each copy; half of the compile time went into copies of copies. LLVM does not inline functions of more than a
few dozen instructions anyway, so all but small ones stay separate: callers find them by symbol, and loading a
caller from the cache loads them first.
"""

import importlib
import sys
from dataclasses import dataclass
from functools import cache
from typing import Any

import llvmlite.binding as llvm
from numba.core.compiler import CompileResult
from numba.core.dispatcher import Dispatcher

from surefoot.kernels.compiling_faster import is_tried

__all__ = ["Missing", "keep_apart", "rebuild", "reduce"]

_LARGE = 300
"""Instructions from which a function stays separate."""


class Missing(Exception):
    """A cached kernel calls one that is missing."""


@dataclass(frozen=True)
class Need:
    """A kernel that must be loaded before its caller; Numba calls this when it loads the caller."""

    module: str
    name: str
    signature: Any
    symbol: str

    def __call__(self) -> None:
        kernel = getattr(importlib.import_module(self.module), self.name)
        kernel.compile(self.signature)


@cache
def _is_possible() -> bool:
    """With other versions of Numba, kernels are copied as usual."""
    return sys.platform.startswith("linux") and is_tried()


def keep_apart(compiled: CompileResult, kernel: Dispatcher, signature: Any) -> None:
    """From now on, callers of ``kernel`` do not copy it if it is large."""
    library = compiled.library
    name = kernel.py_func.__name__
    module = sys.modules.get(kernel.py_func.__module__)
    if module is None or getattr(module, name, None) is not kernel:
        return
    if not _is_possible() or not _is_large(compiled):
        return
    library._shared_module = _empty_module(library)
    library._reload_init = {Need(module.__name__, name, signature, compiled.fndesc.mangled_name)}


def reduce(compiled: CompileResult) -> tuple:
    """Cached form of a compiled kernel."""
    payload = compiled._reduce()
    library, own = compiled.library, compiled.fndesc.mangled_name
    # Numba does not list a callback's dependencies with the callback
    needs = {*compiled.reload_init, *library._reload_init}
    itself = [need for need in needs if isinstance(need, Need) and need.symbol == own]
    defined = _engine(compiled.target_context)._defined_symbols
    called = [each.name for each in library._final_module.functions if each.is_declaration]
    return itself, list(needs.difference(itself)), [name for name in called if name in defined], payload


def rebuild(target: Any, kept: tuple) -> CompileResult:
    """A compiled kernel from its form made by `reduce`; loads the kernels it calls first.

    Raises `Missing` if one of them has changed: LLVM would end the process.
    """
    itself, needs, called, payload = kept
    for need in needs:
        need()
    engine = _engine(target)
    for name in called:
        if not engine.is_symbol_defined(name):
            raise Missing(name)
    if itself:
        names = payload[1]
        engine._defined_symbols.update(
            (names.mangled_name, names.llvm_cpython_wrapper_name, names.llvm_cfunc_wrapper_name)
        )
    compiled = CompileResult._rebuild(target, *payload)
    compiled.library._reload_init = set(itself or needs)
    return compiled


def _is_large(compiled: CompileResult) -> bool:
    function = compiled.library.get_function(compiled.fndesc.mangled_name)
    count = 0
    for block in function.blocks:
        count += sum(1 for _ in block.instructions)
        if count > _LARGE:
            return True
    return False


def _empty_module(library: Any) -> Any:
    return llvm.parse_assembly(str(library.codegen._create_empty_module(library.name)))


def _engine(target: Any) -> Any:
    return target.codegen()._engine
