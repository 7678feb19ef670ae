"""Kernels: functions that Numba compiles, once on a machine, and keeps in a folder of the user's."""

from surefoot.kernels.decorators import allocating_kernel, cfunc, kernel

__all__ = ["allocating_kernel", "cfunc", "kernel"]
