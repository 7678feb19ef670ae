"""The plan of a run-up as it is noted, and slippery ground."""

import numpy as np

from locomotion import Ground, Human
from locomotion.gaits.run import controller
from locomotion.preconditions.moments import PLAN, make_slippery, planned
from locomotion.skills.course import make_course
from locomotion.skills.run_up_layout import RUN_UP_SIZE


def test_the_plan_ends_at_the_mark_and_a_farther_mark_comes_earlier():
    course = make_course([("jump", 0.4, 0.0)], [8.0])
    human = Human(Ground.from_arrays(course.vertices, course.faces), rehearsals=0)
    human.reset(course.path[0], 0.0, 3.0)
    human.follow(course.path, 3.5, course.obstacles)
    human.tick()
    obstacle, run, memory = course.obstacles[0], human.on_feet.run_skill, np.zeros(RUN_UP_SIZE)
    skill = human.run_up.skill_for(obstacle)
    steps, early, following, entry = planned(human.control, obstacle, skill, run, memory, False)
    assert steps >= 4 and abs(early) < 0.05 and 2.0 < following < 5.0
    assert entry == skill.approach(obstacle.size)[0] and len(PLAN) == 4
    human.control[controller.PLANTED] = 0.0
    off = planned(human.control, obstacle, skill, run, memory, True)
    np.testing.assert_allclose(off[:2], [0.0, 8.0 - skill.approach(obstacle.size)[1]])
    make_slippery(human.model, 0.7)
    assert (human.model.geom_friction[:, 0] == 0.7).all()
