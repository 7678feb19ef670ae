"""Equal digests, equal kernels: what a kernel's code depends on changes its digest, and nothing else does."""

import re
from types import FunctionType, ModuleType

import numba
import numpy as np
import pytest

from surefoot.kernels.dependencies import digest_of_code, digest_of_type

SOURCE = """
import numba
import numpy as np
TABLE = np.array([1.0, 2.0])
FACTOR = 2.0
UNUSED = 1

@numba.njit
def helper(x):
    # a comment
    return x + 1.0

def used(x, far=3):
    total = 0.0
    for k in range(4):
        total += helper(x) * FACTOR
    return total + TABLE[0]
"""


def digest(source):
    """The digest of ``used`` in a module with this source."""
    module = ModuleType("navmesh.made")
    exec(compile(source, "made.py", "exec"), vars(module))
    assert isinstance(module.used, FunctionType)
    return digest_of_code(module.used)


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ("FACTOR = 2.0", "FACTOR = 2"),
        ("1.0, 2.0]", "1.0, 2.5]"),
        ("range(4)", "range(5)"),
        ("far=3", "far=4"),
        ("x + 1.0", "x + 1.5"),
        ("@numba.njit", "@numba.njit(fastmath=True)"),
        ("+ TABLE[0]", "- TABLE[0]"),
        ("* FACTOR", "* UNUSED"),
    ],
)
def test_what_it_uses_counts(before, after):
    assert before in SOURCE
    assert digest(SOURCE.replace(before, after)) != digest(SOURCE)


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ("# a comment", "# another"),
        ("UNUSED = 1", "UNUSED = 2"),
        ("\n@numba", "\n\n\ndef new(): pass\n\n@numba"),
    ],
)
def test_comments_lines_and_other_code_do_not(before, after):
    assert digest(re.sub(before, after, SOURCE)) == digest(SOURCE)


def test_kernels_that_call_each_other_have_a_digest():
    circle = SOURCE.replace("x + 1.0", "x + 1.0 if x > 0 else other(x)")
    circle += "\n@numba.njit\ndef other(x):\n    return helper(-x) + 7.0\n"
    assert digest(circle) != digest(circle.replace("7.0", "8.0"))


def test_types_differ_by_their_parts():
    array = numba.typeof(np.zeros(3))
    matrix = numba.typeof(np.zeros((3, 3)))
    pairs = [numba.types.Tuple([array, each]) for each in (array, matrix)]
    digests = [digest_of_type(each) for each in (array, matrix, *pairs)]
    assert len(set(digests)) == 4
    assert digest_of_type(numba.typeof(np.ones(9))) == digests[0]
