"""When a walking person steps, and where it leads its foot."""

import math

import mujoco
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from locomotion import Human
from locomotion.body.person import JOINT_NAMES, STEPS_PER_TICK, PersonIndex, build_person
from locomotion.gaits.run.controller import COM, COM_VELOCITY, OBSERVED, new_state, observe
from locomotion.gaits.walk.controller import observe_walk, walk_tick
from locomotion.gaits.walk.layout import (
    CLOCK,
    FOOTHOLD,
    LIFT,
    LIFT_NORMAL,
    LIFT_YAW,
    PHASE,
    SEEN_FEET,
    SEEN_SOLES,
    SIDEWAYS,
    SINGLE,
    SWING_ANGLES,
    SWING_TIME,
    WALK_HEADING,
    WALK_SPEED,
    WALK_STANCE,
    WALK_TURN_RATE,
    first_gains,
    new_walk,
)
from locomotion.gaits.walk.skill import load_walk_skill, plant
from locomotion.gaits.walk.steps import TURN_RATE, begin_swing, follow
from locomotion.ground.ground import plane_lookup


def stand(ticks, pushes):
    """A person told to stand for ``ticks``, pushed on its chest with ``pushes``: [N] by the tick at which one
    begins, for 0.1 s."""
    human = Human(None, clearing=())
    human.reset((0, 0, 0), 0.5)
    command = np.array([0.5, 0.0, 0.0, 0.0])
    tables, walk, state, data = human.on_feet.walk_skill.tables, new_walk(0.5), human.control, human.data
    observe_walk(human.index, data, walk)
    for tick in range(ticks):
        force = [push for begin, push in pushes.items() if begin <= tick < begin + 10]
        data.xfrc_applied[human.index.chest, :2] = force[0] if force else 0.0
        walk_tick(tables, plane_lookup(), walk, state[OBSERVED], command, data.qpos, data.qvel, data.ctrl)
        mujoco.mj_step(human.model, data, STEPS_PER_TICK)
        observe(human.index, human.model, data, state)
        observe_walk(human.index, data, walk)
    return human


def test_stands_still_for_a_minute_and_stays_up_when_pushed():
    human = stand(6000, {begin: (60.0, -40.0) for begin in range(1000, 6000, 1500)})
    assert human.data.xmat[1, 8] > 0.97
    assert np.linalg.norm(human.com[:2]) < 1.0


@pytest.mark.parametrize("side_deg", range(0, 360, 30))
def test_pushed_hard_from_any_side_it_steps_and_stands(side_deg):
    side = math.radians(side_deg)
    human = stand(700, {100: (200.0 * math.cos(side), 200.0 * math.sin(side))})
    assert human.data.xmat[1, 8] > 0.97
    assert 0.1 < np.linalg.norm(human.com[:2]) < 2.0


def test_a_foot_that_finds_no_ground_is_led_to_where_the_body_is_now():
    model = build_person()
    index = PersonIndex.of(model)
    data, state, walk = mujoco.MjData(model), new_state(), new_walk()
    plant(model, data, index, plane_lookup(), state, walk, np.zeros(3), 0.0)
    tables, command = load_walk_skill().tables, np.array([0.0, 1.0, 0.0, 0.0])
    state[COM_VELOCITY] = 0.0, 0.2, 0.0  # towards the left foot, which bears it
    led = []
    for tick in range(150):  # the swing foot hangs in the air, the body is carried on at 1 m/s after a second
        state[COM][0] += 0.01 * (tick > 100)
        state[26:28] = 0.0, 600.0
        walk_tick(tables, plane_lookup(), walk, state[OBSERVED], command, data.qpos, data.qvel, data.ctrl)
        led.append(walk[FOOTHOLD][0])
    assert walk[PHASE] == SINGLE and led[-1] > led[100] + 0.2


def told(walk, ticks, heading=0.0, speed=0.0, sideways=0.0, each=0.0):
    """The greatest turn rate while it follows for ``ticks``; ``heading`` grows by ``each`` a tick."""
    fastest = 0.0
    for _ in range(ticks):
        heading += each
        follow(walk, heading, speed, sideways)
        fastest = max(fastest, abs(walk[WALK_TURN_RATE]))
    return fastest


def test_its_reference_speeds_follow_what_is_asked_as_fast_as_it_can():
    walk = new_walk()
    told(walk, 50, speed=1.2, sideways=-0.3)
    assert walk[WALK_SPEED] == pytest.approx(0.4) and walk[SIDEWAYS] == pytest.approx(-0.25)
    told(walk, 150, speed=1.2, sideways=-0.3)
    assert walk[WALK_SPEED] == pytest.approx(1.2) and walk[SIDEWAYS] == pytest.approx(-0.3)
    told(walk, 50)
    assert walk[WALK_SPEED] == pytest.approx(0.7)


def test_it_turns_faster_along_a_bend_than_when_it_is_told_elsewhere_at_once():
    walk = new_walk()
    assert told(walk, 300, heading=2.0) == pytest.approx(TURN_RATE)
    assert walk[WALK_HEADING] == pytest.approx(2.0, abs=0.01)
    walk = new_walk()
    assert TURN_RATE < told(walk, 200, speed=0.5, each=0.016) < 1.75
    assert abs(math.remainder(walk[WALK_HEADING] - 200 * 0.016, 2 * math.pi)) < 0.6


def test_it_turns_the_shorter_way_round():
    walk = new_walk(3.0)
    told(walk, 300, heading=-3.0)
    assert abs(math.remainder(walk[WALK_HEADING] + 3.0, 2 * math.pi)) < 0.01
    walk = new_walk(3.0)
    told(walk, 5, heading=-3.0)
    assert walk[WALK_TURN_RATE] > 0.0


@pytest.mark.parametrize(("stance", "swing"), [(1.0, 0), (-1.0, 1)])
def test_a_swing_begins_where_its_foot_and_leg_are(stance, swing):
    rng = np.random.default_rng(4)
    walk, qpos = new_walk(), rng.normal(size=46)
    walk[WALK_STANCE] = stance
    walk[SEEN_SOLES] = rng.normal(size=6)
    turn = Rotation.from_euler("ZX", [0.4, 0.1])  # it stands on a slope, and is turned
    walk[SEEN_FEET] = np.tile(turn.as_matrix().ravel(), 2)
    gains = first_gains()
    begin_swing(gains, walk, qpos)
    assert (walk[PHASE], walk[CLOCK], walk[SWING_TIME]) == (SINGLE, 0.0, gains[0])
    assert np.array_equal(walk[LIFT], walk[SEEN_SOLES].reshape(2, 3)[swing])
    assert walk[LIFT_NORMAL] == pytest.approx(turn.as_matrix()[:, 2]) and walk[LIFT_YAW] == pytest.approx(0.4)
    hip = JOINT_NAMES.index(f"{('right', 'left')[swing]}_hip_flexion")
    assert np.array_equal(walk[SWING_ANGLES], qpos[7 + hip : 13 + hip])
