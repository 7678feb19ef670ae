"""How kernels are compiled."""

from functools import partial

from numba import njit

__all__ = ["allocating_kernel", "kernel"]

kernel = partial(njit, cache=True, _nrt=False)
"""Compiles a function that makes no arrays, as ``@kernel`` or ``@kernel(error_model="numpy")``.

Numba counts references to arrays wherever a function takes one or looks one up in a bundle, with an atomic
operation each time: half of the time of many kernels, and of the time to compile them. A function that only
reads and writes arrays that it is given needs no counting. It must not return an array, nor call what returns
a new one. Numba refuses to compile one that makes an array itself.
"""
allocating_kernel = partial(njit, cache=True, _nrt=True)
"""Compiles a function that makes, copies or returns arrays."""
