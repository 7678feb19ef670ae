"""What was used last is kept, and no more than so much."""

from collections import Counter
from functools import partial
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
