"""Take-offs with and without odds are the same starts, counted by what came of them."""

from benchmarks.taking_off import Try, try_once
from locomotion.skills.registry import skill_called


def test_one_who_takes_what_comes_takes_off_where_a_timid_one_turns_away():
    kind = skill_called("vault")
    sizes, seed = (1.35, 1.4), [1, 0]
    brave, timid = try_once(kind, sizes, None, seed), try_once(kind, sizes, 0.1, seed)
    assert brave.off and not brave.turned
    assert timid == Try(off=False, held=False, turned=True, fell=False)
