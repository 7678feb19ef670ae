"""A saved person that nobody can be is refused, and says why."""

from dataclasses import replace

import numpy as np
import pytest

from locomotion import Ground
from locomotion.body.physics import physics_size
from locomotion.errors import LocomotionError
from locomotion.gaits.residual.layout import MEMORY_SIZE
from locomotion.gaits.run import layout as run
from locomotion.gaits.walk import layout as walk
from locomotion.human.human import Human
from locomotion.human.landing import LASTS
from locomotion.human.saved_state_check import check_person
from locomotion.human.state import MOVING
from locomotion.paths.command import COMMAND_SIZE
from locomotion.paths.smoothing import ObstacleAhead
from locomotion.paths.table import GAIT
from locomotion.skills.course import make_course
from tests.locomotion.human.people import flat_ground

WALK = run.STATE_SIZE + COMMAND_SIZE
LANDING = WALK + walk.WALK_SIZE + MEMORY_SIZE
"""Where the numbers of the walk, and of what corrects a landing, begin."""
STAIR = ObstacleAhead(10.0, "jump", 0.4, np.array([10.0, 0.0, 0.4]), np.array([-1.0, 0.0, 0.0]))


@pytest.fixture(scope="module")
def human():
    made = Human(flat_ground())
    made.reset((0, 0, 0), 0.0)
    made.follow([[0, 0, 0], [18, 0, 0]], 3.0, [STAIR])
    for _ in range(60):
        made.tick()
    return made


def changed(human, place, value):
    state = human.save_state()
    numbers = state.numbers.copy()
    numbers[place] = value
    return state._replace(numbers=numbers)


@pytest.mark.parametrize("foresight", [(-1, 0), (10**9, 0), (0, -3), (0, float("nan"))])
def test_what_nobody_can_have_rehearsed_is_refused(human, foresight):
    with pytest.raises(LocomotionError, match="rehearse"):
        check_person(human.save_state()._replace(foresight=foresight), human)


def test_every_state_of_a_walk_a_run_and_a_stop_is_accepted():
    human = Human(flat_ground(), rehearsals=0)
    check_person(human.save_state(), human)
    human.reset((0, 0, 0), 0.0, 3.0)
    human.follow([[0, 0, 0], [12, 0, 0]], 3.0)
    seen = set()
    while human.status in MOVING:
        human.tick()
        if human.ticks % 5 == 0:
            check_person(human.save_state(), human)
            seen.add(human.status)
    check_person(human.save_state(), human)
    assert seen >= {"walking", "running"} and human.status == "arrived"


@pytest.mark.parametrize(
    ("place", "value", "says"),
    [
        (
            run.STANCE,
            0.5,
            f"the run of a person: number {run.STANCE} is 0.5, expected a whole number from -1",
        ),
        (run.PHASE, 1.5, f"the run of a person: number {run.PHASE}"),
        (run.STATE_SIZE, np.nan, "the command of a person: number 0 is nan"),
        (WALK + walk.PHASE, 7.0, f"the walk of a person: number {walk.PHASE} is 7"),
        (LANDING, LASTS + 2, "what corrects the landing of a person: number 0 is 252"),
        (LANDING, -0.5, "what corrects the landing of a person: number 0 is -0.5, expected a whole number"),
        (LANDING + 1, np.nan, "what corrects the landing of a person: number 1 is nan"),
        (-1, np.inf, "the physics of a person holds numbers that are not finite"),
    ],
)
def test_a_number_that_cannot_be_is_named_with_its_part(human, place, value, says):
    with pytest.raises(LocomotionError) as told:
        check_person(changed(human, place, value), human)
    assert str(told.value).startswith(says)


@pytest.mark.parametrize(
    ("place", "value", "says"),
    [
        (1, 5e3, "far from the level"),
        (4, 2.0, "the length of a person's quaternion is 2"),
        (10, 200.0, "a joint of a person is 200"),
        (1 + 46, 2e3, "a speed of a person is 2000"),
        (0, -1.0, "the physics' time is -1"),
    ],
)
def test_a_body_that_cannot_be_is_refused(human, place, value, says):
    """``place``: in the physics, which begin with the time, then the pose and its rates."""
    begin = len(human.save_state().numbers) - physics_size(human.model)
    with pytest.raises(LocomotionError, match=says):
        check_person(changed(human, begin + place, value), human)


def damages(state):
    table = state.path.table.copy()
    table[3, GAIT] = 0.5
    return {
        "belongs to another model": {"numbers": state.numbers[:-1]},
        "a person is 'flying', which nobody can be": {"status": "flying"},
        "is walking along no path": {"path": None, "obstacles": (), "status": "walking"},
        "a tick of a person is -1": {"ticks": -1},
        "a mood of a person is nan": {"slowing": float("nan")},
        "gone in no gait": {"path": replace(state.path, table=table)},
        "the goal of a path": {"path": replace(state.path, goal=np.zeros(2))},
        "an obstacle affords 'climb'; valid: jump": {"obstacles": (replace(STAIR, affordance="climb"),)},
        "the normal of an obstacle is 2": {"obstacles": (replace(STAIR, normal=np.array([2.0, 0, 0])),)},
        "before an obstacle that it cannot clear": {"obstacles": (replace(STAIR, height=3.0),)},
        "obstacles before it and no path": {"path": None, "status": "standing"},
        "is jumping by no skill": {"status": "jumping"},
        "a person clears no obstacle": {"obstacles": (), "skill": np.zeros(3)},
        "has shape|is an array of shape": {"skill": np.zeros(3)},
    }


def test_parts_that_do_not_fit_each_other_are_refused(human):
    state = human.save_state()
    check_person(state, human)
    for says, change in damages(state).items():
        with pytest.raises(LocomotionError, match=says):
            check_person(state._replace(**change), human)


def test_every_tick_of_a_leap_can_be_saved():
    course = make_course([("gap", 1.2, 0.0)], [12.0])
    made = Human(Ground.from_arrays(course.vertices, course.faces), rehearsals=0)
    made.reset(course.path[0], 0.0)
    made.follow(course.path, 3.5, course.obstacles)
    phases = []
    while not phases or made.run_up.clearing:
        made.tick()
        assert made.status in MOVING
        if made.run_up.clearing:
            check_person(made.save_state(), made)
            phases.append(made.control[run.PHASE])
    assert min(phases) < 0.0  # a step that is held back from its first tick on
