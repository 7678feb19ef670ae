"""Load all cached kernels, so that no first call has to."""

import sys

from numba.core.dispatcher import Dispatcher

from surefoot.kernels.cache import KernelCache
from surefoot.kernels.dependencies import is_ours

__all__ = ["load_kept"]


def load_kept() -> int:
    """Load the cached code of all kernels in the imported modules; returns how many."""
    count = 0
    for module in [module for name, module in sys.modules.items() if is_ours(name)]:
        for kernel in vars(module).values():
            if isinstance(kernel, Dispatcher) and kernel.py_func.__module__ == module.__name__:
                cache = kernel._cache
                if isinstance(cache, KernelCache):
                    for signature in cache.kept_signatures(kernel.targetctx):
                        kernel.compile(signature)
                        count += 1
    return count
