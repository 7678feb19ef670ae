"""The drop-roll: law against the reference, mirror image, refusals, saving, and rolls off ledges."""

import numpy as np
import pytest

from locomotion.body.person import JOINT_NAMES, person_spec
from locomotion.body_events import Cleared, TookOff
from locomotion.clips.clip import load_clip
from locomotion.errors import LocomotionError
from locomotion.gaits.run import controller
from locomotion.human.human import Human
from locomotion.human.state import MOVING
from locomotion.paths.smoothing import ObstacleAhead
from locomotion.skills.drop_roll import kernel as dr
from locomotion.skills.drop_roll.reference import wanted_pose
from locomotion.skills.drop_roll.skill import (
    DROP_ROLL_CLIP,
    DropRoll,
    drop_roll_clip,
    load_drop_roll_skill,
    tables_of,
)
from locomotion.skills.kernel import MIRROR, MIRROR_SIGN, mirror
from runtime.evaluation.courses import enter_course, make_course, run_course

N = len(JOINT_NAMES)


@pytest.fixture(scope="module")
def skill():
    return load_drop_roll_skill()


def dropper(height, distance):
    return enter_course(make_course([("drop", height, 0.0)], [distance]))


def random_tables(seed):
    rng = np.random.default_rng(seed)
    parameters = 0.2 * rng.normal(size=sum(dr.PARAMETERS.values()))
    parameters[dr.parameter_slices()["timing"]] = 0.05, 0.1, 0.06, 0.12
    return tables_of(parameters, 0.3 * rng.normal(size=(dr.BINS, len(dr.SENSORS))))


def random_tick(seed, phase, share):
    """State, position, velocity and memory in the middle of a fall or a roll."""
    rng = np.random.default_rng(seed)
    state, memory = controller.new_state(), np.zeros(dr.MEMORY_SIZE)
    state[controller.COM] = 1.0, 0.1, 1.2
    state[controller.COM_VELOCITY] = 3.0, 0.2, -2.0
    state[controller.FEET] = 1.1, -0.1, 0.4, 0.9, 0.2, 0.5
    qpos, qvel = np.zeros(7 + N), 0.5 * rng.normal(size=6 + N)
    qpos[3:7] = rng.normal(size=4) + np.array([4.0, 0.0, 1.0, 0.0])
    qpos[3:7] /= np.linalg.norm(qpos[3:7])
    dr.start_drop_roll(memory, 1.0, -1.0 if phase == dr.FALL else 0.1, 0.0, 0.0, 1.0, 0.0)
    memory[dr.PHASE], memory[dr.SHARE], memory[dr.SHARE_RATE] = phase, share, 0.8
    memory[dr.ANGLE], memory[dr.PHASE_TICKS] = 0.3, 4.0
    return state, qpos, qvel, memory


@pytest.mark.parametrize(
    ("phase", "share"), [(dr.FALL, 0.02), (dr.FALL, 0.15), (dr.ROLL, 0.4), (dr.ROLL, 0.9)]
)
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_kernel_agrees_with_the_reference(phase, share, side):
    tables = random_tables(3)
    state, qpos, qvel, memory = random_tick(11, phase, share)
    memory[dr.SIDE] = side
    before = np.random.default_rng(1).normal(size=N)
    memory[14 : 14 + N] = before
    ctrl = np.zeros(N)
    dr.drop_roll_tick(tables.parameters, *tables.rest, memory, state, qpos, qvel, ctrl)
    assert memory[dr.PHASE] == phase
    np.testing.assert_allclose(ctrl, wanted_pose(tables, memory, state, before), atol=1e-12)


def test_a_roll_over_the_left_shoulder_is_the_mirror_image():
    tables = random_tables(5)
    state, qpos, qvel, memory = random_tick(2, dr.ROLL, 0.5)
    other, seen = memory.copy(), state.copy()
    other[dr.SIDE] = -1.0
    for part in (controller.COM, controller.COM_VELOCITY):
        seen[part] *= [1.0, -1.0, 1.0]
    feet = state[controller.FEET].reshape(2, 3)[::-1] * [1.0, -1.0, 1.0]
    seen[controller.FEET] = feet.ravel()
    place, speed = qpos.copy(), qvel.copy()
    place[3:7] *= [1.0, -1.0, 1.0, -1.0]
    speed[:6] *= [1.0, -1.0, 1.0, -1.0, 1.0, -1.0]
    place[7:], speed[6:] = mirror(qpos[7:]), mirror(qvel[6:])
    right, left = np.zeros(N), np.zeros(N)
    dr.drop_roll_tick(tables.parameters, *tables.rest, memory, state, qpos, qvel, right)
    dr.drop_roll_tick(tables.parameters, *tables.rest, other, seen, place, speed, left)
    np.testing.assert_allclose(left, mirror(right), atol=1e-12)
    assert (MIRROR[MIRROR] == np.arange(N)).all() and set(MIRROR_SIGN) == {1.0, -1.0}


def test_the_clip_stays_within_the_joints_ranges():
    clip = load_clip(DROP_ROLL_CLIP)
    low, high = person_spec().compile().jnt_range[1:].T
    poses = clip.sample(np.linspace(0.0, 1.0, 101))
    assert (poses >= low - 1e-6).all() and (poses <= high + 1e-6).all()
    assert not drop_roll_clip().cyclic


def test_heights_that_were_not_learned_are_refused(skill):
    low, high = skill.range
    assert low <= 0.9 and high >= 2.0
    for height in (low - 0.1, high + 0.1, np.nan):
        with pytest.raises(LocomotionError, match="not learned"):
            skill.at(height)
    human = Human()
    ahead = ObstacleAhead(10.0, "drop", 2.6, np.zeros(3), np.array([-1.0, 0.0, 0.0]))
    with pytest.raises(LocomotionError, match=r"no skill clears drop 2.60 m.*drop 0.9 to 2 m"):
        human.follow([[0, 0, 0], [20, 0, 0]], 3.5, [ahead])


@pytest.mark.parametrize("height", [0.9, 1.5, 2.0])
def test_rolls_off_a_ledge_and_goes_on(height):
    arrived = 0
    for distance in np.linspace(12.0, 21.0, 5):
        human = dropper(height, distance)
        turned, upside_down = 0.0, False
        while human.status in MOVING and human.time < 40.0:
            human.tick()
            if human.status == "dropping":
                upside_down = upside_down or 2.0 * human.qpos[4:6] @ human.qpos[4:6] > 1.9
                turned = max(turned, human.save_state().skill[dr.ANGLE])
        assert upside_down and turned > 5.0
        kinds = [type(event) for event in human.events]
        assert kinds.index(TookOff) < kinds.index(Cleared)
        arrived += human.status == "arrived"
    assert arrived == 5


def test_most_drops_succeed():
    rng = np.random.default_rng(4)
    starts = [(float(rng.uniform(0.9, 2.0)), float(rng.uniform(10, 20))) for _ in range(6)]
    results = [run_course(make_course([("drop", height, 0.0)], [distance])) for height, distance in starts]
    assert sum(result.ended == "arrived" for result in results) >= 5
    assert all(result.reports[0].peak < 25.0 for result in results)


def test_a_body_that_does_not_come_up_has_fallen(skill):
    never = skill.table.copy()
    never[:, dr.parameter_slices()["rise"].start] = 20.0
    stuck = type(skill)(skill.kind, skill.heights, never, skill.references, skill.stride, skill.run)
    result = run_course(make_course([("drop", 1.2, 0.0)], [10.0]), [DropRoll(stuck)], rehearsals=0)
    assert result.ended == "fallen in the skill"
