"""Load all cached kernels, so that no first call has to."""

import sys
from pathlib import Path

from numba.core.dispatcher import Dispatcher

from surefoot.kernels.cache import KernelCache
from surefoot.kernels.dependencies import is_ours

__all__ = ["load_kept"]


def load_kept() -> list[Path]:
    """Load the cached code of all kernels in the imported modules; returns its files."""
    files: list[Path] = []
    for module in [module for name, module in sys.modules.items() if is_ours(name)]:
        for kernel in vars(module).values():
            if isinstance(kernel, Dispatcher) and kernel.py_func.__module__ == module.__name__:
                cache = kernel._cache
                if isinstance(cache, KernelCache):
                    for file, signature in cache.kept(kernel.targetctx):
                        kernel.compile(signature)
                        files.append(file)
    return files
