"""The compiled policy against the plain form that learning uses, on the whole figure."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest

from locomotion.body.person import JOINT_NAMES, STEPS_PER_TICK, PersonIndex
from locomotion.gaits.policy import law
from locomotion.gaits.policy import layout as at
from locomotion.gaits.policy.kernel import Parts, decide_tick, feel, new_memory
from locomotion.gaits.policy.layout import FELT_SIZE, FORCES, SOLES
from locomotion.gaits.policy.motion import Motion
from locomotion.gaits.policy.skill import PolicySkill, load_policy
from locomotion.training.policies.figure import Figure
from locomotion.training.policies.network import forward, new_layers


@pytest.fixture
def skill() -> PolicySkill:
    """A policy of random weights over a random motion."""
    rng = np.random.default_rng(3)
    joints, rates = 0.2 * rng.standard_normal((2, 4, 16, len(at.JOINTS)))
    motion = Motion(
        np.array([0.0, 0.9, 4.0]), np.array([1.6, 1.3, 0.6]), joints, rates, np.array([0.05, 0.15])
    )

    def network():
        layers = new_layers((at.INPUTS, 16, 16, at.ACTIONS), rng, 0.5)
        mean, deviation = rng.standard_normal(at.INPUTS), rng.uniform(0.5, 2.0, at.INPUTS)
        return mean.astype(np.float32), deviation.astype(np.float32), *layers

    return PolicySkill(motion, network(), network(), network())


def plain_tick(skill, memory, asked, seen):
    """One decision in the plain form; ``memory`` (1, STATE_SIZE). Gives targets of the policy's joints."""
    if memory[0, at.STARTED]:
        law.advance(memory, skill.motion, asked[None], seen)
    memory[0, at.STARTED] = 1.0
    network = skill.walk if memory[0, at.RUNNING] else skill.stand
    mean, deviation, *layers = skill.run if memory[0, at.FAST] else network
    x = (law.observe(memory, seen) - mean) / deviation
    law.decide(memory, forward(layers, np.clip(x, -8.0, 8.0).astype(np.float32))[-1])
    return law.targets(memory, skill.motion)[0]


@pytest.mark.parametrize("style", [np.zeros(5), [-0.06, 0.5, 0.03, 0.1, -0.2]], ids=("usual", "own"))
def test_it_decides_as_the_plain_form_from_what_its_sensors_say(skill, style):
    figure = Figure(whole=True, timestep=0.0025)
    model, data = figure.model, mujoco.MjData(figure.model)
    parts = Parts(PersonIndex.of(model), model)
    data.qpos[2] = 0.9
    felt, memory = np.zeros(FELT_SIZE), new_memory(0.4)
    memory[at.SPEED], memory[at.RUNNING] = 0.3, 1.0
    memory[at.STYLE] = style
    plain = memory[None].copy()
    columns = [JOINT_NAMES.index(name) for name in at.JOINTS]
    halves, states = set(), []
    for tick in range(160):
        asked = np.array([1.6 if tick < 45 else 0.0, 0.5])
        if tick == 100:  # in a stand, on which it cannot stay
            for each in (memory, plain[0]):
                each[at.STARTED] = each[at.RUNNING] = 0.0
        mujoco.mj_step(model, data, STEPS_PER_TICK)
        feel(parts, data, felt)
        np.testing.assert_allclose(felt[SOLES], data.sensordata[SOLES], atol=1e-12)
        np.testing.assert_allclose(felt[FORCES], data.sensordata[FORCES], atol=1e-9)
        seen = law.Seen(
            data.qpos[None], data.qvel[None], data.qpos[None, figure.angles], data.qvel[None, figure.rates],
            felt[None, SOLES].reshape(1, 6, 3), felt[None, FORCES],
        )  # fmt: skip
        wanted = plain_tick(skill, plain, asked, seen)
        decide_tick(*skill.tables, memory, asked, felt, data.qpos, data.qvel, data.ctrl)
        halves.add(bool(memory[at.PHASE] >= 0.5))
        states.append(bool(memory[at.RUNNING]))
        np.testing.assert_allclose(memory, plain[0], atol=2e-5)
        np.testing.assert_allclose(data.ctrl[columns], wanted, atol=2e-5)
        assert data.ctrl[JOINT_NAMES.index("neck_pitch")] == memory[at.HEAD_BEND]
    assert halves == {False, True}, "both halves of the cycle were seen"
    assert states == [True] * 100 + [False] + [True] * 59, "and a stand, and a step out of it"


def test_it_decides_as_the_plain_form_from_any_state(skill):
    """Standing, about to, stepping in place, setting off, walking, running; near a stand and far from one."""
    rng, columns = np.random.default_rng(5), [JOINT_NAMES.index(name) for name in at.JOINTS]
    changes, gaits = set(), set()
    for _ in range(800):
        memory = new_memory(rng.uniform(-3.0, 3.0))
        memory[at.STARTED], memory[at.RUNNING] = 1.0, rng.integers(2)
        memory[at.PHASE] = rng.uniform(0.0, 1.0)
        if rng.random() < 0.5:
            memory[at.PHASE] = rng.uniform(law.BOTH_BEAR, law.LIFT_OFF) + 0.5 * rng.integers(2)
        memory[at.RESTED] = rng.choice([-0.3, 0.0, 0.2, 0.6])
        memory[[at.TOLD, at.SPEED]] = rng.choice([0.0, 0.02, 0.3, 1.2]) + rng.choice([0.0, 0.05])
        memory[at.TURN_RATE], memory[at.TRIM] = rng.choice([0.0, 0.03, -0.7]), rng.uniform(-0.3, 0.3)
        memory[[at.LAG_AHEAD, at.LAG_LEFT]] = rng.choice([0.02, 0.5]) * rng.normal(size=2)
        memory[at.ACTION], memory[at.CHANGE] = rng.normal(size=at.ACTIONS), rng.normal()
        memory[at.FAST] = memory[at.RUNNING] * rng.integers(2)
        if memory[at.FAST]:
            memory[[at.TOLD, at.SPEED]] *= rng.choice([1.0, 2.6])
        asked = np.array([rng.choice([0.0, 0.03, 0.2, 1.5, 3.1]), rng.choice([0.0, 0.03, 0.9])])
        if rng.random() < 0.2:
            asked[at.ASKED_SPEED] = memory[at.TOLD] + 0.02
        seen = standing(skill, memory, rng.choice([0.0, 0.05, 0.1]), rng.choice([0.0, 0.1, 0.5]))
        seen.forces[0, 2 * rng.integers(2)] *= rng.choice([0.0, 0.5, 1.0])
        if rng.random() < 0.2:  # nearly at rest
            memory[[at.TOLD, at.SPEED, at.TURN_RATE, at.LAG_AHEAD, at.LAG_LEFT]] = 0.0
            seen, asked[:] = standing(skill, memory), 0.0
        turned = law.along(np.array([-memory[at.HEADING]]), seen.soles)
        seen = replace(seen, soles=turned, qvel=seen.qvel + 0.02 * rng.normal(size=(1, 6)))
        qpos, qvel, ctrl = np.zeros(46), np.zeros(45), np.zeros(39)
        qpos[:7], qvel[:6] = seen.qpos[0], seen.qvel[0]
        felt, plain = np.append(seen.soles.ravel(), seen.forces), memory[None].copy()
        wanted = plain_tick(skill, plain, asked, seen)
        before, fast = memory[at.RUNNING], memory[at.FAST]
        decide_tick(*skill.tables, memory, asked, felt, qpos, qvel, ctrl)
        changes.add((before, memory[at.RUNNING]))
        gaits.add((fast, memory[at.FAST]))
        np.testing.assert_allclose(memory, plain[0], atol=2e-5)
        np.testing.assert_allclose(ctrl[columns], wanted, atol=2e-5)
    assert changes == gaits == {(0.0, 0.0), (0.0, 1.0), (1.0, 0.0), (1.0, 1.0)}


def test_a_run_begins_when_it_is_asked_for_and_ends_when_the_body_is_slow(skill):
    memory = new_memory(0.0)[None]
    memory[:, at.RUNNING], memory[:, [at.TOLD, at.SPEED]] = 1.0, 1.2

    def go(asked, seconds, speed=None):
        for _ in range(round(seconds / at.POLICY_DT)):
            pace = memory[0, at.TOLD] if speed is None else speed
            law.advance(memory, skill.motion, np.array([[asked, 0.0]]), standing(skill, memory, speed=pace))

    go(law.RUNS_FROM, 1.0)
    assert memory[0, at.FAST] == 0.0
    assert law.shown_speed(memory)[0] <= law.FASTEST_WALK
    told = memory[0, at.TOLD]
    go(5.0, 0.5)
    assert memory[0, at.FAST] == 1.0
    assert memory[0, at.TOLD] == pytest.approx(told + 0.5 * law.RUN_ACCELERATION, abs=0.05)
    go(1.0, 4.0, speed=2.6)
    assert memory[0, at.FAST] == 1.0, "the body is too fast yet"
    assert law.shown_speed(memory)[0] == pytest.approx(2.6 - law.SHOWN_WITHIN, abs=0.02)
    go(1.0, 4.0)
    assert memory[0, at.FAST] == 0.0
    assert memory[0, at.TOLD] == pytest.approx(1.0)


def test_who_speeds_up_is_shown_how_to_run_but_not_much_faster_than_it_is():
    assert law.shown_speed(running(3.5, lag=-0.2))[0] == pytest.approx(3.5)
    assert law.shown_speed(running(3.5, lag=-1.9))[0] == pytest.approx(1.6 + law.SHOWN_AHEAD)
    assert law.shown_speed(running(2.0, lag=-1.7))[0] == pytest.approx(0.3 + law.SHOWN_WITHIN)


def running(told, lag=0.0):
    """What a running person remembers, (1, STATE_SIZE): its speed [m/s], and how much faster its body is."""
    memory = new_memory(0.0)[None]
    memory[:, [at.RUNNING, at.FAST]], memory[:, [at.TOLD, at.SPEED]] = 1.0, told
    memory[:, at.LAG_AHEAD] = lag
    return memory


@pytest.mark.parametrize(("lag", "share"), [(-0.2, 1.0), (0.0, 1.0), (0.5, 0.5), (1.0, 0.0), (1.4, 0.0)])
def test_who_brakes_is_told_to_brake_less_the_more_the_body_is_too_fast(skill, lag, share):
    memory = running(4.0, lag * law.MOST_AHEAD)
    law.advance(memory, skill.motion, np.zeros((1, 2)), standing(skill, memory, speed=4.0))
    assert 4.0 - memory[0, at.TOLD] == pytest.approx(share * law.RUN_BRAKING[0] * at.POLICY_DT)


def test_who_stops_out_of_a_run_runs_slowly_until_the_walk_takes_over(skill):
    memory = running(3.0)
    for _ in range(200):
        pace = max(memory[0, at.TOLD], 1.9)
        law.advance(memory, skill.motion, np.zeros((1, 2)), standing(skill, memory, speed=pace))
    assert memory[0, at.FAST] == 1.0 and memory[0, at.TOLD] == pytest.approx(law.SLOWEST_RUN)
    for _ in range(200):
        law.advance(memory, skill.motion, np.zeros((1, 2)), standing(skill, memory, speed=memory[0, at.TOLD]))
    assert memory[0, at.FAST] == 0.0 and memory[0, at.TOLD] == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize(
    ("asked", "speed", "most"),
    [(4.0, 4.0, law.RUN_SIDEWAYS / 4.0), (1.5, 2.0, law.RUN_SIDEWAYS / 2.0), (0.0, 1.3, law.ENDS_TURNING)],
)
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_run_turns_no_tighter_than_its_speed_allows(skill, asked, speed, most, side):
    memory = running(speed)
    for _ in range(30):
        memory[:, [at.TOLD, at.SPEED, at.LAG_AHEAD, at.TRIM]] = speed, speed, 0.0, 0.0
        memory[:, at.FAST] = 1.0
        law.advance(
            memory, skill.motion, np.array([[asked, 1.2 * side]]), standing(skill, memory, speed=speed)
        )
    assert memory[0, at.TURN_RATE] == pytest.approx(side * most, abs=0.03)


def test_it_remembers_how_fast_the_speed_told_changes(skill):
    memory = running(2.5)
    for _ in range(40):
        pace = memory[0, at.TOLD]
        law.advance(memory, skill.motion, np.array([[5.0, 0.0]]), standing(skill, memory, speed=pace))
    assert memory[0, at.CHANGE] == pytest.approx(law.RUN_ACCELERATION, rel=0.01)
    assert law.observe(memory, standing(skill, memory))[0, at.CHANGE_SEEN] == memory[0, at.CHANGE]


def test_the_mirror_image_of_a_person_decides_the_mirror_image(skill):
    """Exactly: the policy cannot favour a side."""
    rng = np.random.default_rng(1)
    memory = np.tile(new_memory(0.0), (40, 1))
    memory[:, at.PHASE], memory[:, at.RUNNING] = rng.uniform(0.0, 0.5, 40), 1.0
    memory[:, at.SPEED], memory[:, at.TURN_RATE] = rng.uniform(0, 2, 40), rng.uniform(-1, 1, 40)
    memory[:, [at.LAG_AHEAD, at.LAG_LEFT]] = rng.normal(size=(40, 2))
    seen = random_people(rng, 40)
    other, image = memory.copy(), mirror_image(seen)
    other[:, at.PHASE] += 0.5
    other[:, [at.TURN_RATE, at.LAG_LEFT]] *= -1.0
    np.testing.assert_allclose(law.observe(other, image), law.observe(memory, seen), atol=1e-12)
    decided = rng.normal(size=(40, at.ACTIONS))
    law.decide(memory, decided)
    law.decide(other, decided)
    np.testing.assert_array_equal(
        memory[:, at.ACTION][:, at.MIRROR_ACTION] * at.SIGN_ACTION, other[:, at.ACTION]
    )


def random_people(rng, count):
    qpos, qvel = rng.normal(size=(count, 7)), rng.normal(size=(count, 6))
    qpos[:, 3:] = [1.0, 0.0, 0.0, 0.0] + 0.2 * qpos[:, 3:]
    qpos[:, 3:] /= np.linalg.norm(qpos[:, 3:], axis=1, keepdims=True)
    angles, rates = rng.normal(size=(2, count, len(at.JOINTS)))
    return law.Seen(
        qpos, qvel, angles, rates, rng.normal(size=(count, 6, 3)), rng.uniform(0, 400, (count, 4))
    )


def mirror_image(seen):
    """Reflected in the plane y = 0."""
    qpos, qvel = seen.qpos.copy(), seen.qvel.copy()
    qpos[:, [1, 4, 6]] *= -1.0  # y; and of the quaternion, the turns about x and z
    qvel[:, [1, 3, 5]] *= -1.0
    angles, rates = (each[:, at.MIRROR_JOINT] * at.SIGN_JOINT for each in (seen.angles, seen.rates))
    soles = seen.soles[:, [3, 4, 5, 0, 1, 2]] * [1.0, -1.0, 1.0]
    return law.Seen(qpos, qvel, angles, rates, soles, seen.forces[:, [2, 3, 0, 1]])


def test_signs_of_mirrored_joints_are_those_of_the_model():
    """A pose and its mirror image put the soles at mirrored places."""
    figure = Figure(whole=False, timestep=0.005)
    data, rng = mujoco.MjData(figure.model), np.random.default_rng(2)
    angles = rng.uniform(0.3 * figure.limits[:, 0], 0.3 * figure.limits[:, 1])
    places = []
    for pose in (angles, angles[at.MIRROR_JOINT] * at.SIGN_JOINT):
        data.qpos[:7] = [0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0]
        data.qpos[figure.angles] = pose
        mujoco.mj_kinematics(figure.model, data)
        places.append(data.site_xpos[figure.soles].copy())
        hands = [data.body(f"{side}_hand").xpos.copy() for side in ("right", "left")]
        places[-1] = np.vstack([places[-1], hands])
    order = [3, 4, 5, 0, 1, 2, 7, 6]
    np.testing.assert_allclose(places[1], places[0][order] * [1.0, -1.0, 1.0], atol=1e-12)


def standing(skill, memory, ahead=0.0, speed=0.0):
    """A person that stands as the reference does, ``ahead`` [m] of its feet, and moves at ``speed`` [m/s]."""
    soles = np.zeros((1, 6, 3))
    soles[0, [0, 1, 3, 4], 0] = skill.motion.stance[0] - ahead
    soles[0, :3, 1], soles[0, 3:, 1] = -0.5 * skill.motion.stance[1], 0.5 * skill.motion.stance[1]
    qpos, qvel = np.zeros((1, 7)), np.zeros((1, 6))
    qpos[0, 3], qvel[0, 0] = 1.0, speed
    joints, forces = np.zeros((1, len(at.JOINTS))), np.full((1, 4), 0.25 * at.BODY_WEIGHT)
    return law.Seen(qpos, qvel, joints, joints, soles, forces)


def test_the_clock_stops_at_lift_off_after_an_order_to_stand(skill):
    memory = new_memory(0.0)[None]
    memory[:, at.RUNNING], memory[:, at.PHASE] = 1.0, 0.3
    seen, compiled = standing(skill, memory), memory[0].copy()
    body = np.zeros(46), np.zeros(45), np.zeros(39)
    body[0][3] = 1.0
    felt = np.append(seen.soles.ravel(), seen.forces)
    for _ in range(100):
        law.advance(memory, skill.motion, np.zeros((1, 2)), seen)
        decide_tick(*skill.tables, compiled, np.zeros(2), felt, *body)
        compiled[at.ACTION] = 0.0
    decide_tick(*skill.tables, compiled, np.zeros(2), felt, *body)  # the first one does not go on
    np.testing.assert_allclose(compiled[: at.ACTION.start], memory[0, : at.ACTION.start], atol=1e-12)
    assert memory[0, at.RUNNING] == 0.0
    assert memory[0, at.PHASE] in (law.LIFT_OFF, law.LIFT_OFF + 0.5)
    law.advance(memory, skill.motion, np.array([[1.0, 0.0]]), standing(skill, memory))
    assert memory[0, at.RUNNING] == 1.0


@pytest.mark.parametrize("what", [{"speed": 0.3}, {"ahead": 0.09}, {"apart": 0.3}], ids=str)
def test_the_clock_goes_on_for_who_cannot_stand_yet(skill, what):
    memory = new_memory(0.0)[None]
    memory[:, at.RUNNING] = 1.0
    what = dict(what)
    apart = what.pop("apart", 0.0)
    seen = standing(skill, memory, **what)
    seen.soles[0, :3, 0] += apart
    for _ in range(200):
        law.advance(memory, skill.motion, np.zeros((1, 2)), seen)
    assert memory[0, at.RUNNING] == 1.0


@pytest.mark.parametrize(("speed", "stands"), [(0.0, True), (0.2, False)])
def test_who_is_nearly_still_stands_after_a_while_with_a_foot_in_the_air(skill, speed, stands):
    memory = new_memory(0.0)[None]
    memory[:, at.RUNNING] = 1.0
    seen = standing(skill, memory, speed=speed)
    seen.forces[0, :2] = 0.0
    stood = []
    for _ in range(200):
        law.advance(memory, skill.motion, np.zeros((1, 2)), seen)
        stood.append(memory[0, at.RUNNING] == 0.0)
    assert not any(stood[: round(law.CATCHES / at.POLICY_DT)])
    assert stood[-1] == stands


def test_who_is_pushed_off_its_feet_steps_with_the_one_that_bears_less(skill):
    memory = new_memory(0.0)[None]
    for side, phase in ((0, law.LIFT_OFF + 0.5), (1, law.LIFT_OFF)):  # which lifts the right, the left
        memory[:, at.RUNNING] = 0.0
        seen = standing(skill, memory, speed=0.15)
        law.advance(memory, skill.motion, np.zeros((1, 2)), seen)
        assert memory[0, at.RUNNING] == 0.0
        seen = standing(skill, memory, speed=0.5)
        seen.forces[0, 2 * side] = 0.0
        law.advance(memory, skill.motion, np.zeros((1, 2)), seen)
        assert memory[0, at.RUNNING] == 1.0
        assert memory[0, at.PHASE] == pytest.approx(phase)


def test_who_is_told_to_turn_on_the_spot_steps_and_then_stands_again(skill):
    memory, seen = new_memory(0.0)[None], standing(skill, memory=None)
    soles = seen.soles.copy()
    for turn, seconds in ((0.8, 2.0), (0.0, 3.0)):
        asked = np.array([[0.0, turn]])
        law.advance(memory, skill.motion, asked, seen)
        assert memory[0, at.RUNNING] == 1.0
        for _ in range(round(seconds / at.POLICY_DT)):
            law.advance(memory, skill.motion, asked, seen)
            face(seen, memory[0, at.HEADING])
            seen.soles[:] = law.along(-memory[:, at.HEADING], soles)  # its feet turn with it
    assert memory[0, at.RUNNING] == 0.0
    assert memory[0, at.HEADING] == pytest.approx(0.8 * 2.0, abs=0.1)


def test_the_heading_waits_for_a_body_that_does_not_turn_and_follows_one_that_is_thrown_round(skill):
    memory, seen = new_memory(0.0)[None], standing(skill, memory=None)
    for _ in range(100):
        law.advance(memory, skill.motion, np.array([[0.0, 0.8]]), seen)
    assert memory[0, at.HEADING] == pytest.approx(law.MOST_TWIST)
    face(seen, -2.0)
    law.advance(memory, skill.motion, np.array([[0.0, 0.8]]), seen)
    assert memory[0, at.HEADING] == pytest.approx(-2.0 + law.MOST_TWIST)


def test_a_body_that_is_too_slow_is_not_told_to_be_faster(skill):
    told = []
    for slower in (0.1, 1.5):
        memory = new_memory(0.0)[None]
        memory[:, at.RUNNING] = 1.0
        for _ in range(100):
            seen = standing(skill, memory, speed=memory[0, at.SPEED] - slower)
            law.advance(memory, skill.motion, np.array([[1.5, 0.0]]), seen)
        told.append(memory[0, at.TOLD])
    assert told[0] == pytest.approx(1.5)
    assert told[1] < 0.2


def face(seen, yaw):
    """Turn a body to ``yaw`` [rad]."""
    seen.qpos[0, [3, 6]] = np.cos(0.5 * yaw), np.sin(0.5 * yaw)


def test_who_sets_off_steps_in_place_first(skill):
    memory, told = new_memory(0.0)[None], []
    memory[:, at.STARTED] = 1.0
    for _ in range(100):
        law.advance(memory, skill.motion, np.array([[1.0, 0.0]]), standing(skill, memory))
        assert memory[0, at.RUNNING] == 1.0
        told.append(memory[0, at.TOLD])
    waits = round(law.FIRST_STEPS / at.POLICY_DT)
    assert max(told[: waits - 2]) == 0.0
    assert told[waits + 5] > 0.0
    assert memory[0, at.RESTED] == 0.0


def test_a_bearing_foot_stays_where_it_is_while_the_body_turns(skill):
    memory = np.zeros((50, at.STATE_SIZE))
    memory[:, at.TURN_RATE], memory[:, at.RUNNING] = 0.6, 1.0
    phase = np.linspace(0.0, 1.0, 50, endpoint=False)
    feet = law.turned_feet(memory, phase, np.full(50, 1.1))
    right, left = feet.T
    np.testing.assert_allclose(left, np.roll(right, 25), atol=1e-12)
    bears = phase < law.BEARING
    turned = 0.6 * 1.1 * phase[bears]  # of the body since the foot came down
    np.testing.assert_allclose(right[bears] + turned, right[0], atol=1e-12)
    assert right[0] > 0.15, "put down turned ahead"
    assert np.abs(right.mean()) < 0.01


@pytest.mark.parametrize(("steadies", "most"), [(True, law.TRIM_IN_USE), (False, law.MOST_TRIM)])
def test_it_is_asked_for_more_where_it_is_too_slow(skill, steadies, most):
    memory = new_memory(0.0)[None]
    memory[:, [at.TOLD, at.SPEED, at.RUNNING]] = 1.0
    for _ in range(500):
        seen = standing(skill, memory, speed=0.9)
        law.advance(memory, skill.motion, np.array([[1.0, 0.0]]), seen, steadies=steadies)
    assert memory[0, at.SPEED] == pytest.approx(1.0 + most)


@pytest.mark.parametrize("steadies", [True, False])
def test_who_creeps_in_place_is_asked_for_less_than_nothing_until_it_stands(skill, steadies):
    memory = new_memory(0.0)[None]
    memory[:, at.RUNNING] = 1.0
    for _ in range(200):
        creeps = standing(skill, memory, speed=0.09)
        creeps.soles[0, :3, 0] += 0.3
        law.advance(memory, skill.motion, np.zeros((1, 2)), creeps, steadies=steadies)
    assert memory[0, at.SPEED] == pytest.approx(-law.REST_TRIM if steadies else 0.0)
    assert memory[0, at.RUNNING] == 1.0
    for _ in range(100):
        law.advance(memory, skill.motion, np.zeros((1, 2)), standing(skill, memory), steadies=steadies)
    assert memory[0, at.RUNNING] == 0.0
    assert memory[0, at.SPEED] == 0.0
    assert abs(memory[0, at.LAG_AHEAD]) < 0.01


def test_who_is_thrown_back_is_not_told_to_walk_forwards(skill):
    memory = new_memory(0.0)[None]
    memory[:, at.RUNNING] = 1.0
    for _ in range(60):
        law.advance(memory, skill.motion, np.zeros((1, 2)), standing(skill, memory, speed=-0.4))
    assert memory[0, at.SPEED] == 0.0
    assert memory[0, at.RUNNING] == 1.0


def test_a_file_gives_back_the_policy(skill, tmp_path):
    skill.save(tmp_path / "policy.npz")
    again = load_policy(tmp_path / "policy.npz")
    for one, other in zip(sum(again.tables, ()), sum(skill.tables, ()), strict=True):
        np.testing.assert_allclose(one, other, rtol=1e-6, atol=1e-7)
