"""A small run of the benchmark of random levels."""

from benchmarks.getting_nowhere import run


def test_nobody_gets_nowhere_in_silence_on_a_random_level():
    results = run(levels=1, seed=7001, people=1, seconds=40.0)
    assert results and not any(each["silent"] or each["falls_going_back"] for each in results)
