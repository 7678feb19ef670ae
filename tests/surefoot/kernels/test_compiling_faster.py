"""Numba compiles faster, and the same."""

import itertools
import operator

import numba
import numpy as np
import pytest
from numba import types
from numba.core import event
from numba.core.compiler import Flags
from numba.core.registry import cpu_target
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


def test_operators_have_the_types_that_numba_finds():
    context = cpu_target.typing_context
    context.refresh()
    numbers = types.float64, types.int64, types.int32, types.uint8, types.boolean, types.literal(3)
    pairs = list(itertools.product(numbers, numbers))
    asked = [(each, pair) for each in (operator.add, operator.lt, operator.truediv) for pair in pairs]
    asked += [(operator.neg, (kind,)) for kind in numbers[:4]]
    table = types.float64[:, ::1]
    for index in (types.int64, types.uint8, types.literal(1), types.UniTuple(types.int64, 2)):
        asked += [(operator.getitem, (table, index)), (operator.setitem, (table, index, types.float64))]
    for operation, args in asked:
        kind = context.resolve_value_type(operation)
        found = kind.get_call_type(context, args, {})
        assert found is kind.get_call_type(context, args, {})
        assert found == compiling_faster._resolve(kind, context, args, {})


def test_a_function_of_numpy_is_compiled_once_whatever_its_callers_have_set(monkeypatch, tmp_path):
    monkeypatch.setattr(numba.config, "CACHE_DIR", str(tmp_path))

    def spread(count):
        return np.full((count, 3), np.float32(7.0), np.float32).sum()

    compiled = []
    for options in ({}, {"nogil": True}, {"error_model": "numpy"}):
        with event.install_recorder("numba:compile") as record:
            assert allocating_kernel(**options)(spread)(2) == 42.0
        compiled.append(sum(one.is_start for _, one in record.buffer))
    assert compiled[0] > compiled[1] == 1 < compiled[2]


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
