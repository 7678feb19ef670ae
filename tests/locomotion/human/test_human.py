"""The person as a whole: it follows paths, repeats bit for bit, can be saved, and refuses what it cannot
do."""

import numpy as np
import pytest

from locomotion.body_events import Arrived, SetOff
from locomotion.errors import LocomotionError
from locomotion.human.human import Human
from locomotion.human.state import MOVING
from locomotion.paths.smoothing import ObstacleAhead
from tests.locomotion.human.people import STRAIGHT, finish, flat_ground


@pytest.mark.parametrize("on_mesh", [False, True])
def test_runs_a_straight_path_and_arrives(on_mesh):
    human = Human(flat_ground() if on_mesh else None)
    human.reset((0, 0, 0), 0.0)
    human.follow(STRAIGHT, 3.0)
    lateral = finish(human)
    assert human.status == "arrived"
    assert [type(e) for e in human.events] == [SetOff, Arrived]
    assert human.events[-1].distance <= 0.5
    assert np.percentile(lateral, 95) < 0.3
    assert np.linalg.norm(human.position[:2] - [15, 0]) <= 0.5
    assert human.position[2] == pytest.approx(0.0, abs=1e-6)
    while not human.held:  # it comes to rest
        assert human.time < 30.0
        human.tick()
    assert np.linalg.norm(human.position[:2] - [15, 0]) <= 0.5
    held = human.qpos
    human.tick()
    assert np.array_equal(held, human.qpos) and not human.velocity.any()


def test_same_start_gives_the_same_run_and_persons_do_not_disturb_each_other():
    ground = flat_ground()
    first, second, other = Human(ground), Human(ground), Human(None)
    assert first.model is second.model
    for human, yaw in ((first, 0.0), (second, 0.0), (other, 1.0)):
        human.reset((0, 0, 0), yaw)
        human.follow(STRAIGHT, 3.0)
    for _ in range(200):
        first.tick()
    for _ in range(200):
        other.tick()
        second.tick()
    assert first.state_hash() == second.state_hash() != other.state_hash()
    assert first.qpos.tobytes() == second.qpos.tobytes()


def test_saved_person_goes_on_bit_for_bit():
    ground = flat_ground()
    human, twin = Human(ground), Human(ground)
    human.reset((1, 2, 0), 0.0)
    human.follow(STRAIGHT + np.array([1, 2, 0]), 3.0)
    for _ in range(130):
        human.tick()
    saved = human.save_state()
    human.body_transforms()
    for _ in range(150):
        human.tick()
    twin.restore_state(saved)
    assert twin.time == saved.ticks * 0.01 and twin.events == list(saved.events)
    for _ in range(150):
        twin.tick()
    assert twin.state_hash() == human.state_hash()
    assert twin.body_transforms().tobytes() == human.body_transforms().tobytes()
    assert human.body_transforms().shape == (human.model.nbody, 7)


def test_saved_state_of_another_model_is_refused_and_changes_nothing():
    human, other = Human(None, clearing=()), Human(None, clearing=())
    other.follow(STRAIGHT, 1.0)
    other.tick()
    before, saved = human.state_hash(), other.save_state()
    assert other.state_hash() != before
    with pytest.raises(LocomotionError, match="another model"):
        human.restore_state(saved._replace(numbers=saved.numbers[:-1]))
    assert human.state_hash() == before


def test_what_is_no_ground_or_number_of_rehearsals_is_refused():
    for rehearsals in (-1, 1.5, None, True):
        with pytest.raises(LocomotionError, match="rehearsals must be a whole number"):
            Human(None, rehearsals=rehearsals)
    with pytest.raises(LocomotionError, match="ground must be a Ground, or None for a plane, not 'plane'"):
        Human("plane")  # type: ignore[arg-type]


@pytest.mark.parametrize("yaw", [0.0, 1.5, 3.1])
def test_walks_to_a_near_goal_turning_on_the_spot_first_and_comes_to_rest_there(yaw):
    human = Human(flat_ground())
    human.reset((3, 1, 0), yaw)
    human.follow([[3, 1, 0], [3, -4, 0]], 3.0)
    seen = set()
    while human.status in MOVING and human.time < 30.0:
        human.tick()
        seen.add(human.status)
        if abs(human.yaw + np.pi / 2) > 1.0:
            assert np.linalg.norm(human.position[:2] - [3, 1]) < 0.4
    assert human.status == "arrived" and seen == {"walking", "arrived"}
    for _ in range(700):
        human.tick()
    assert human.held
    assert np.linalg.norm(human.position[:2] - [3, -4]) < 0.25
    assert human.data.xmat[1, 8] > 0.98  # upright


def test_wrong_input_is_refused_and_changes_nothing():
    human = Human(flat_ground())
    human.reset((0, 0, 0), 0.0)
    before = human.state_hash()
    far = ObstacleAhead(5.0, "vault", 1.8, np.zeros(3), np.array([-1.0, 0, 0]))
    for call, message in (
        (lambda: human.follow([[0, 0, 0]], 3.0), "at least two points"),
        (lambda: human.follow([[0, 0, 0], [np.nan, 0, 0]], 3.0), "finite"),
        (lambda: human.follow(STRAIGHT, -1.0), "speed"),
        (lambda: human.follow(STRAIGHT + np.array([0, 9, 0]), 3.0), "the path begins at"),
        (lambda: human.follow(STRAIGHT, 3.0, [far]), "no skill clears vault 1.80 m"),
        (lambda: human.reset((0, 0, np.inf), 0.0), "finite"),
        (lambda: human.reset((0, 0, 0), 0.0, -1.0), "speed"),
        (lambda: human.reset((0, 0, 7.0), 0.0), "no ground within"),
        (lambda: human.reset((500, 0, 0), 0.0), "no ground within"),
        (lambda: human.follow("there", 3.0), r"numbers of the shape \(n, 3\), not 'there'"),
        (lambda: human.follow([[0, 0, 0], [1]], 3.0), "numbers of the shape"),
        (lambda: human.follow(STRAIGHT, None), "speed must be .* not None"),
        (lambda: human.follow(STRAIGHT, "fast"), "speed must be .* not fast"),
        (lambda: human.follow(STRAIGHT, 3.0, None), "list of ObstacleAhead, not a NoneType"),
        (lambda: human.follow(STRAIGHT, 3.0, [5]), "obstacle 0 is a int; expected an ObstacleAhead"),
        (lambda: human.reset("there", 0.0), "finite"),
        (lambda: human.reset((0, 0, 0), None), "finite"),
        (lambda: human.reset((0, 0, 0), 0.0, "fast"), "speed"),
        (lambda: human.change_ground(None), "cannot go on on a NoneType"),
        (lambda: Human(None).change_ground(flat_ground()), "on the endless plane cannot go on"),
        (lambda: human.restore_state(None), "from a HumanState, not from a NoneType"),
    ):
        with pytest.raises(LocomotionError, match=message):
            call()
    assert human.state_hash() == before and not human.events
