"""What is kept of bots' runs."""

import numpy as np

from runtime.playtest.bots import BotRun, Passing, Trouble, Visit
from runtime.playtest.tally import Tally, sighted


def trouble(kind, x, time=1.0):
    return Trouble(kind, time, (x, 0.0, 0.0), -1, np.zeros((5, 4)), np.zeros((5, 2, 7)))


def tallied(*runs):
    tally = Tally(np.zeros((1, 3)))
    for run in runs:
        tally.add(run)
    return tally


def test_troubles_join_the_first_place_that_is_near():
    """1.8 m are near, 3.6 m are not: the third is far from the first, however near to the second."""
    one, two, three = trouble("stuck", 0.0), trouble("lost", 1.8), trouble("stuck", 3.6, 2.0)
    tally = tallied(BotRun(0, "roamer", troubles=[one]), BotRun(1, "roamer", troubles=[two, three]))
    (_, first), (_, second) = tally.clusters()
    assert [kind for kind, _ in tally.clusters()] == ["stuck", "stuck"]
    assert (first.first, second.first) == (one, three)
    assert [(each.bot, each.position[0]) for each in first.sightings] == [(0, 0.0), (1, 1.8)]


def test_the_first_trouble_at_a_place_can_be_shown_and_no_other():
    one, two = trouble("fell", 0.0), trouble("fell", 0.5)
    runs = BotRun(0, "roamer", troubles=[one]), BotRun(1, "roamer", troubles=[two])
    tally = tallied(*runs)
    ((_, cluster),) = tally.clusters()
    assert tally.met(cluster.sightings[0]) is one is sighted(runs[0], cluster.sightings[0])
    assert tally.met(cluster.sightings[1]) is None and sighted(runs[1], cluster.sightings[1]) is two


def test_attempts_visits_and_time_add_up():
    visit = Visit("a", "b", 2.0, 2.5, True)
    runs = [
        BotRun(n, "trier", 3.0, [], [], [visit], [Passing(4, n == 1), Passing(2, True)]) for n in range(3)
    ]
    tally = tallied(*runs)
    assert (tally.attempts, tally.cleared) == ({4: 3, 2: 3}, {4: 1, 2: 3})
    assert tally.seconds == 9.0 and tally.visits == [visit] * 3
