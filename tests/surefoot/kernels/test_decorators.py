"""Kernels that create no arrays, and which versions of a kernel are compiled."""

import numba
import numpy as np
import pytest
from numba.core.errors import NumbaError

from surefoot.kernels import kernel


@pytest.fixture(autouse=True)
def apart(monkeypatch, tmp_path):
    """The kernels of these tests leave nothing behind."""
    monkeypatch.setattr(numba.config, "CACHE_DIR", str(tmp_path))


def test_one_that_makes_an_array_is_refused():
    @kernel
    def makes(count):
        return np.empty(count)[0]

    with pytest.raises(NumbaError):
        makes(3)


def test_constants_and_short_integers_share_the_code_for_whole_numbers():
    @kernel
    def twice(x):
        return 2 * x

    @kernel
    def calls(a):
        return twice(3) + twice(4) + twice(a)

    assert calls(np.int32(5)) == 24
    assert twice.signatures == [(numba.types.int64,)]


def test_others_keep_their_types():
    @kernel
    def half(x):
        return x / 2

    @kernel
    def calls(a, b):
        return half(a) + half(b)

    assert calls(np.uint32(3), np.float32(3.0)) == 3.0
    assert {kind for (kind,) in half.signatures} == {numba.types.uint32, numba.types.float32}


def test_options_are_those_of_numba():
    @kernel(error_model="numpy")
    def over(x):
        return 1.0 / x

    @kernel
    def checked(x):
        return 1.0 / x

    assert over(0.0) == np.inf
    with pytest.raises(ZeroDivisionError):
        checked(0.0)
