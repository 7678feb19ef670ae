"""Compile kernels ahead of time, so that nobody has to wait for it later."""

from runtime.warmup.ahead import compile_kernels, is_compiled, load_kernels, prepare

__all__ = ["compile_kernels", "is_compiled", "load_kernels", "prepare"]
