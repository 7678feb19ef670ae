"""Kernels: functions compiled by Numba, once per machine, and kept in the user's cache folder."""

from surefoot.kernels.decorators import allocating_kernel, cfunc, kernel

__all__ = ["allocating_kernel", "cfunc", "kernel"]
