"""What a falling person does so that the ground hurts it less."""

import math

import mujoco
import numpy as np
import pytest

from benchmarks.falling import PARTS, FallSeen, Watch
from locomotion import Human
from locomotion.body.arm_reach import hand_place
from locomotion.body_events import Fell
from locomotion.recovery import bracing
from locomotion.recovery.layout import BRACING, LIMP, MODE, ROLL_SIDE, SEEN_TURN, new_scramble
from locomotion.recovery.postures import mirrored
from tests.locomotion.recovery.falling import push_over

HEAD, HANDS = PARTS.index("head"), PARTS.index("hands")


def _turned(rotation: np.ndarray) -> np.ndarray:
    """Memory of a body whose pelvis has that rotation (3, 3)."""
    memory = new_scramble()
    memory[SEEN_TURN] = rotation.ravel()
    return memory


def _rotation(vector: np.ndarray) -> np.ndarray:
    """(3, 3) by a rotation vector [rad]."""
    quaternion, out = np.empty(4), np.empty(9)
    angle = float(np.linalg.norm(vector))
    mujoco.mju_axisAngle2Quat(quaternion, vector / max(angle, 1e-9), angle)
    mujoco.mju_quat2Mat(out, quaternion)
    return out.reshape(3, 3)


def test_the_ground_is_foreseen_where_the_pelvis_turns_to():
    rng = np.random.default_rng(3)
    for _ in range(30):
        now, spin = _rotation(rng.normal(size=3)), rng.normal(size=3)
        spin *= 0.1 / np.linalg.norm(spin)  # slowly, so that the straight line is the arc
        qvel, seen = np.zeros(45), np.empty(3)
        qvel[3:6] = spin
        bracing.part_that_lands(_turned(now), qvel, seen)
        soon = now @ _rotation(spin * bracing._FORESIGHT)
        assert np.linalg.norm(seen) == pytest.approx(1.0)
        assert np.allclose(seen, -soon[2], atol=1e-3)


def test_who_falls_to_the_other_side_does_the_mirror_image():
    rng, flip = np.random.default_rng(4), np.diag([1.0, -1.0, 1.0])
    for _ in range(20):
        turn, spin, ctrl = _rotation(rng.normal(size=3)), rng.normal(size=3), np.empty((2, 39))
        for k, (pelvis, rates) in enumerate(((turn, spin), (flip @ turn @ flip, spin * [-1.0, 1.0, -1.0]))):
            memory, qvel = _turned(pelvis), np.zeros(45)
            qvel[3:6] = rates
            bracing.begin_to_brace(memory, qvel)
            bracing.brace(memory, qvel, ctrl[k])
        assert np.allclose(mirrored(ctrl[0]), ctrl[1])


def test_hands_go_where_it_falls():
    """In front of a person that tips forward, behind one that tips backward, out at the side it tips to."""
    ahead, memory, qvel, ctrl = [], _turned(np.eye(3)), np.zeros(45), np.empty(39)
    for spin in ((0.0, 3.0, 0.0), (0.0, -3.0, 0.0)):
        qvel[3:6] = spin
        bracing.begin_to_brace(memory, qvel)
        bracing.brace(memory, qvel, ctrl)
        qpos = np.zeros(46)
        qpos[3], qpos[7:] = 1.0, ctrl
        ahead.append([hand_place(qpos, side)[0] for side in (-1.0, 1.0)])
    assert min(ahead[0]) > 0.2 and max(ahead[1]) < -0.1


def _fallen(side: float, limp: bool) -> FallSeen:
    """A fall out of a walk."""
    human, seen = Human(None, clearing=(), gets_up=True), FallSeen("walk", side)
    push_over(human, side, 1.2)
    while not any(isinstance(event, Fell) for event in human.events):
        human.tick()
    assert human.fours.memory[MODE] == BRACING and human.fours.memory[ROLL_SIDE] in (0.0, 1.0)
    if limp:
        human.fours.memory[MODE] = LIMP
    watch = Watch(human)
    for _ in range(100):
        watch.tick(seen)
    return seen


def test_it_falls_softer_than_limp():
    sides = np.arange(0.2, 2.0 * math.pi, math.pi / 4)
    figures = [[_fallen(side, limp).figures() for side in sides] for limp in (False, True)]
    for what, share in (("head", 0.5), ("jolt", 0.6)):
        braced, limp = (np.mean([row[what] for row in rows]) for rows in figures)
        assert braced < share * limp, what


def test_the_servos_stay_within_their_torques():
    human = Human(None, clearing=(), gets_up=True)
    push_over(human, 0.7, 3.0)
    for _ in range(120):
        human.tick()
        limits = human.model.actuator_forcerange
        assert np.all(human.data.actuator_force >= limits[:, 0])
        assert np.all(human.data.actuator_force <= limits[:, 1])
        assert not human.data.xfrc_applied.any() and not human.data.qfrc_applied.any()
