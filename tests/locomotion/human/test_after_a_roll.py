"""What a person does behind a roll."""

import numpy as np

from locomotion.body_events import Cleared
from locomotion.gaits.policy.skill import load_policy
from locomotion.ground.ground import Ground
from locomotion.human.human import Human
from locomotion.human.state import MOVING
from locomotion.skills.course import make_course

_FAR = np.array([30.0, 0.0, 0.0])  # [m] of the way behind the course's own


def test_behind_a_roll_it_goes_on_as_learned_and_runs() -> None:
    course = make_course([("drop", 1.4, 0.0)], [11.0], margin=40.0)
    human = Human(Ground.from_arrays(course.vertices, course.faces), policy=load_policy())
    human.reset(course.path[0], 0.0)
    human.follow(np.vstack([course.path, course.path[-1] + _FAR]), 3.5, course.obstacles)
    behind = None
    while behind is None:
        human.tick()
        assert human.status in MOVING and human.time < 30.0
        behind = human.ticks if any(isinstance(event, Cleared) for event in human.events) else None
    learned_from = None
    while human.ticks < behind + 450:
        human.tick()
        assert human.status in MOVING
        if human.on_feet.walks_as_learned and learned_from is None:
            learned_from = human.ticks - behind
    assert learned_from is not None and learned_from < 150
    assert human.velocity[0] > 2.5
