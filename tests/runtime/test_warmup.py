"""Compiled kernels are known for what they are, so that a later start does not warm up again."""

import os
from pathlib import Path

import navmesh
from runtime.progress import Progress
from runtime.warmup import KERNEL_MODULES, compile_kernels, is_compiled


def test_a_warm_up_is_not_repeated_until_a_kernel_changes(monkeypatch):
    compile_kernels(Progress(shown=False))
    assert is_compiled()
    package, module = KERNEL_MODULES[-1]
    source = Path(navmesh.__file__).parents[1] / package / f"{module}.py"
    stat = Path.stat

    def newer(path, **options):
        found = stat(path, **options)
        return os.stat_result((*found[:8], found[8] + 10**9, found[9])) if path == source else found

    monkeypatch.setattr(Path, "stat", newer)
    assert not is_compiled()
