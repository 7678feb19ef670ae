"""Numba compiles faster, and the same."""

import itertools

import numba
import numpy as np
import pytest
from numba.core.compiler import Flags
from numba.core.targetconfig import TargetConfig

from surefoot.kernels import allocating_kernel, compiling_faster


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


def test_an_array_of_another_shape_is_refused_without_code_that_makes_texts(monkeypatch, tmp_path):
    monkeypatch.setattr(numba.config, "CACHE_DIR", str(tmp_path))

    @allocating_kernel
    def copy_into(target, source):
        target[:2] = source

    made = np.zeros(3)
    copy_into(made, np.array([1.0, 2.0]))
    assert made.tolist() == [1.0, 2.0, 0.0]
    with pytest.raises(ValueError, match="cannot assign slice"):
        copy_into(made, np.zeros(3))
    (compiled,) = copy_into.overloads.values()
    assert not [each for each in compiled.library._final_module.functions if "unicode" in each.name]


def test_versions_that_nobody_has_tried_are_left_alone(monkeypatch):
    monkeypatch.setattr(compiling_faster.numba, "__version__", "0.1.2")
    monkeypatch.setattr(TargetConfig, "__eq__", object.__eq__)
    compiling_faster.compile_faster()
    assert TargetConfig.__eq__ is object.__eq__
