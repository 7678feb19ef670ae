"""A training that takes no time, and what people do along a training path."""

from collections import Counter

import numpy as np

from locomotion.human.human import Human
from locomotion.human.state import MOVING
from locomotion.training.gaits.grounds import training_ground
from locomotion.training.gaits.path_trial import PathScenario
from locomotion.training.gaits.run import RunProblem
from locomotion.training.gaits.run_genes import first_guess, first_state_reference, genes_scale
from locomotion.training.search.loop import Stage


def tiny_problem() -> RunProblem:
    trial = {"duration": 0.2, "noise": 0.2}
    options = {"trials": 1, "style": 0.3, "fall": 0.0, "soft": 0.0, "kinds": ({},), "trial": trial}
    scale = genes_scale(1, 0, 0, "m_ap", "m_sp", "a_hat")
    stages = tuple(Stage(name, 2, 0.1, scale, options, population=4) for name in ("a", "b"))
    return RunProblem(stages, first_guess(), first_state_reference())


def ticks_by_gait(path: PathScenario) -> Counter:
    """How many ticks people go along a path by each gait."""
    human, points = Human(training_ground(path.ground), clearing=(), rehearsals=0), path.points
    human.reset(points[0], float(np.arctan2(*(points[1] - points[0])[[1, 0]])))
    human.follow(points, path.speed)
    gaits: Counter = Counter()
    while human.status in MOVING and human.arc_length < path.length:
        human.tick()
        gaits[human.status] += 1
    return gaits
