"""What was used last is kept, and no more than so much."""

import sys
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from operator import mul
from typing import Any

import numpy as np

from navmesh.recent import KEPT, recent


def test_it_keeps_what_a_list_in_order_of_use_would() -> None:
    rng = np.random.default_rng(0)
    cache: dict[str, Any] = {}
    made, used = Counter(), []
    for key in rng.integers(0, 2 * KEPT, 500).tolist():
        before = made[key]

        def make(key: int) -> int:
            made[key] += 1
            return 10 * key

        assert recent(cache, "tens", key, partial(make, key)) == 10 * key
        assert made[key] - before == (key not in used[-KEPT:])
        used = [*(other for other in used if other != key), key]
    assert len(cache["tens"]) == KEPT


def test_kinds_do_not_push_each_other_out() -> None:
    cache: dict[str, Any] = {}
    first = recent(cache, "one", 0, object)
    for key in range(3 * KEPT):
        recent(cache, "other", key, object)
    assert recent(cache, "one", 0, object) is first


def test_threads_that_ask_at_once_each_get_their_value() -> None:
    cache: dict[str, Any] = {}
    before = sys.getswitchinterval()
    sys.setswitchinterval(1e-6)

    def ask(seed: int) -> bool:
        keys = np.random.default_rng(seed).integers(0, KEPT + 4, 40_000).tolist()
        return all(recent(cache, "tens", key, partial(mul, 10, key)) == 10 * key for key in keys)

    try:
        with ThreadPoolExecutor(8) as pool:
            assert all(pool.map(ask, range(8)))
    finally:
        sys.setswitchinterval(before)
