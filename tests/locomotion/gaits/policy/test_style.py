"""People who differ, moved by the same networks."""

import numpy as np
import pytest

from locomotion.body.person import JOINT_NAMES
from locomotion.body.traits import by_chance, by_hand
from locomotion.gaits.policy import layout as at
from locomotion.gaits.policy.skill import load_policy
from locomotion.gaits.policy.style import WORN, style_of
from locomotion.training.policies.trial import PolicyTrial


def walk(traits: np.ndarray, speed: float, seconds: float = 4.0):
    """Joint angles (ticks, 39) [rad], speed [m/s] and steps a second of a person with these ``traits``, once
    it has its speed."""
    trial = PolicyTrial(load_policy(), traits)
    trial.asked[0] = speed
    assert trial.go(7.0), f"falls with {traits}"
    place, angles, steps = trial.place(), [], 0
    for _ in range(round(seconds * 100)):
        before = trial.memory[at.PHASE]
        trial.tick()
        steps += int(np.floor(2.0 * before) != np.floor(2.0 * trial.memory[at.PHASE]))
        angles.append(trial.data.qpos[7:46].copy())
    return np.array(angles), float(np.linalg.norm(trial.place() - place)) / seconds, steps / seconds


def swing(angles: np.ndarray) -> float:
    return float(np.degrees(np.ptp(angles[:, JOINT_NAMES.index("right_shoulder_flexion")])))


def test_the_usual_person_has_no_style():
    assert not style_of(by_hand()).any()


def test_arms_swing_as_far_as_they_are_told():
    little, usual, much = (walk(by_hand(arms=arms), 1.3)[0] for arms in (0.5, 1.0, 1.5))
    assert swing(little) < 0.7 * swing(usual) and swing(much) > 1.3 * swing(usual)


def test_who_has_more_pace_takes_fewer_steps_at_the_same_speed():
    (_, fast, few), (_, slow, many) = (walk(by_hand(pace=pace), 1.2, 8.0) for pace in (1.15, 0.87))
    assert few < 0.95 * many and abs(fast - 1.2) < 0.1 and abs(slow - 1.2) < 0.1


def test_who_leans_ahead_does_and_looks_ahead_all_the_same():
    angles, usual = (walk(by_hand(lean=lean), 1.2)[0].mean(axis=0) for lean in (0.12, 0.0))
    trunk, neck = JOINT_NAMES.index("waist_pitch"), JOINT_NAMES.index("neck_pitch")
    assert angles[trunk] - usual[trunk] > 0.1 and angles[neck] - usual[neck] < -0.1


def test_more_than_holds_is_not_worn():
    far = style_of(by_hand(width=0.15, arms=0.0, lean=-0.2))
    near = style_of(by_hand(width=WORN["width"][1], arms=WORN["arms"][0], lean=WORN["lean"][0]))
    assert np.array_equal(far, near)


@pytest.mark.parametrize("seed", range(100, 108))
@pytest.mark.parametrize("speed", [0.9, 1.5, 3.5])
def test_anybody_walks_and_runs_and_takes_a_push(seed, speed):
    trial = PolicyTrial(load_policy(), by_chance(seed))
    trial.asked[0] = speed
    assert trial.go(6.0)
    trial.push(200.0, 0.8 * seed)
    assert trial.go(3.0)
    trial.asked[0] = 0.0
    assert trial.go(6.0) and np.hypot(*trial.data.qvel[:2]) < 0.3
