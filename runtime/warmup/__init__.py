"""Compiling the kernels before they are needed, so that nobody waits for it later."""

from runtime.warmup.ahead import compile_kernels, is_compiled, load_kernels, prepare, prepare_once

__all__ = ["compile_kernels", "is_compiled", "load_kernels", "prepare", "prepare_once"]
