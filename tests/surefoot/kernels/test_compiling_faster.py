"""Numba compiles faster, and the same."""

import itertools

from numba.core.compiler import Flags
from numba.core.targetconfig import TargetConfig

from surefoot.kernels import compiling_faster


def test_options_are_equal_if_all_their_values_are():
    """With and without those set that are the default anyway."""
    settings = ({}, {"nrt": False}, {"nrt": True}, {"forceinline": False}, {"nrt": True, "no_compile": True})
    made = []
    for values in settings:
        flags = Flags()
        for name, value in values.items():
            setattr(flags, name, value)
        made.append(flags)
    for one, other in itertools.product(made, repeat=2):
        assert (one == other) == (one.values() == other.values())
        assert one != other or hash(one) == hash(other)
    assert made[0] == made[1] and made[0] != made[2] and made[0] != "none"
    assert TargetConfig.__eq__ is compiling_faster._are_equal


def test_versions_that_nobody_has_tried_are_left_alone(monkeypatch):
    monkeypatch.setattr(compiling_faster.numba, "__version__", "0.1.2")
    monkeypatch.setattr(TargetConfig, "__eq__", object.__eq__)
    compiling_faster.compile_faster()
    assert TargetConfig.__eq__ is object.__eq__
