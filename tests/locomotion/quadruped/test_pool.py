"""Tables of different lengths in one array."""

import numpy as np

from locomotion.quadruped.pool import Pool


def table(value, rows):
    return np.full((rows, 3), float(value))


def test_each_owner_has_its_own_table_wherever_it_lies():
    pool, rng = Pool(3), np.random.default_rng(0)
    kept: dict[int, np.ndarray] = {}
    for step in range(400):
        owner, rows = int(rng.integers(0, 12)), int(rng.integers(0, 200))
        before = {each: pool.region(each) for each in kept if each != owner}
        moved = pool.put(owner, table(step, rows))
        kept[owner] = table(step, rows)
        assert moved or all(pool.region(each) == region for each, region in before.items())
        for each, wanted in kept.items():
            start, count = pool.region(each)
            assert np.array_equal(pool.table(each), wanted) and count == len(wanted)
            assert np.array_equal(pool.rows[start : start + count], wanted)
    assert len(pool.rows) < 20_000  # what was replaced takes no room


def test_without_a_table_there_is_an_empty_one():
    pool = Pool(2)
    assert pool.region(5) == (0, 0) and pool.table(5).shape == (0, 2)


def test_a_table_is_a_copy():
    pool = Pool(3)
    pool.put(0, table(1, 4))
    pool.table(0)[:] = 9.0
    assert np.array_equal(pool.table(0), table(1, 4))


def test_who_comes_after_a_removed_owner_moves_up():
    pool = Pool(3)
    for owner in range(4):
        pool.put(owner, table(owner, owner + 1))
    pool.remove(1)
    assert [len(pool.table(owner)) for owner in range(4)] == [1, 3, 4, 0]
    assert pool.table(2)[0, 0] == 3.0
