"""Learning to brake."""

from dataclasses import replace

import numpy as np

from locomotion import Human
from locomotion.gaits.brake import load_brake_skill
from locomotion.gaits.run.skill import load_run_skill
from locomotion.human.human import BetweenGaits
from locomotion.training.gaits.brake import BrakeProblem, brake_of, draw_starts, first_guess, stop
from locomotion.training.search.loop import Stage


def test_learning_prefers_those_that_stand_soon():
    starts = draw_starts(np.random.default_rng(3), 6, (2.8, 3.2))
    good = Human(None, clearing=(), rehearsals=0)
    first = Human(None, clearing=(), rehearsals=0, between=BetweenGaits(brake=brake_of(first_guess())))
    stops = [[stop(human, start) for start in starts] for human in (good, first)]
    assert np.mean([each.cost() for each in stops[0]]) < np.mean([each.cost() for each in stops[1]])
    assert sum(each.fell for each in stops[0]) < sum(each.fell for each in stops[1])


def test_learning_brakes_as_hard_as_its_stage_says():
    starts = draw_starts(np.random.default_rng(4), 3, (2.8, 3.2))
    stage = Stage("harder", 1, 0.1, np.ones(1), {"trials": 3, "harder": (1.3, 1.6), "ways": 2, "fall": 1.0})
    problem = BrakeProblem((stage,), load_run_skill(), starts)
    drawn = problem.scenarios(stage, 0, np.random.default_rng(0))
    assert len(drawn) == 3 and all((1.3 <= ways).all() and (ways <= 1.6).all() for _, ways in drawn)
    candidate, start = first_guess(), drawn[0][0]
    each = [problem.evaluate(stage, candidate, [(start, ways)])[0] for ways in drawn[0][1].reshape(2, 1)]
    assert problem.evaluate(stage, candidate, drawn[:1])[0] == min(each)
    human, skill = Human(None, clearing=(), rehearsals=0), load_brake_skill()
    twice = Human(
        None,
        clearing=(),
        rehearsals=0,
        between=BetweenGaits(brake=replace(skill, deceleration=1.5 * skill.deceleration)),
    )
    assert stop(human, starts[0], 1.5) == stop(twice, starts[0]) != stop(human, starts[0])
