"""What is kept is found by its key and its sign, and by nothing else."""

import numpy as np

from navmesh.zones.memo import nothing_kept, place_of


def test_what_was_put_in_its_place_is_there_until_something_else_comes():
    kept = nothing_kept(100)
    assert kept.shape == (128, 2)
    rng = np.random.default_rng(0)
    keys, signs = rng.integers(0, 2**62, 300), rng.integers(-(2**63), 2**63 - 1, 300)
    last = {}
    for key, sign in zip(keys, signs, strict=True):
        at, there = place_of(kept, key, sign)
        assert 0 <= at < 128 and not there
        kept[at] = key, sign
        last[at] = key, sign
        assert place_of(kept, key, sign) == (at, True)
        assert not place_of(kept, key, sign ^ 1)[1] and not place_of(kept, key ^ 1, sign)[1]
    assert len(last) > 100
    for at, (key, sign) in last.items():
        assert place_of(kept, key, sign) == (at, True)
