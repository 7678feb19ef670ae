"""Work that threads share."""

import pytest

from navmesh import NavmeshError, NodeGraph
from navmesh.threads import MOST, checked_threads, in_threads, shares
from tests.navmesh.pieces import assert_same
from tests.navmesh.shapes import plane, terrain


@pytest.mark.parametrize("threads", [1, 2, 5])
def test_results_come_in_the_order_of_the_arguments(threads):
    bounds = shares(7, threads)
    assert bounds[0] == 0 and bounds[-1] == 7 and bounds == sorted(bounds)
    assert in_threads(lambda a, b: a - b, [(k, 2 * k) for k in range(4)], threads) == [0, -1, -2, -3]


def test_an_error_in_a_thread_is_raised():
    with pytest.raises(ZeroDivisionError):
        in_threads(lambda number: 1 // number, [(1,), (0,)], 2)


def test_more_threads_than_machines_have_are_no_more_work():
    assert checked_threads(10**9) == MOST and checked_threads(3) == 3
    assert shares(3, 10**9) == [0, 1, 2, 3] and shares(0, 10**9) == [0, 0]
    level = terrain(plane(0, 4, 0, 4))
    one, many = (NodeGraph.build(level, threads=threads) for threads in (1, 10**9))
    assert_same(many, one)


@pytest.mark.parametrize("threads", [0, -1, 1.5, "2", True, None])
def test_a_wrong_number_of_threads_is_an_error(threads):
    with pytest.raises(NavmeshError, match="expected a whole number of at least 1"):
        NodeGraph.build(terrain(plane(0, 4, 0, 4)), threads=threads)
