"""Bad packets and many figures: small versions of the benchmark."""

from benchmarks.dis_safety import crowd_cost, fuzz


def test_bad_packets_do_no_harm(graph):
    """Two thousand (the benchmark: a million)."""
    raised, changed, counts, grown = fuzz(graph, 2000, seed=12)
    assert raised == 0 and changed == 0 and grown < 5.0
    assert counts["packets"] == 2020 and counts["another sender"] > 100 and counts["another version"] > 100


def test_many_figures_are_received(graph):
    assert len(crowd_cost(graph, 30, 1.2, seed=1)) == 3
