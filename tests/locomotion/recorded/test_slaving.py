"""Mapping motion to figures of fewer joints."""

import numpy as np
import pytest

from locomotion.errors import LocomotionError
from locomotion.recorded.motion_set import load_motions
from locomotion.recorded.skeletons import FULL, skeleton
from locomotion.recorded.slaving import TOLERANCES, guessed, landmarks_of, matched, slaved

MOTIONS = load_motions()


def frames(name, step):
    level, clip = MOTIONS.levels[FULL], MOTIONS.clip(name)
    rows = slice(level.first[clip], level.first[clip] + level.count[clip], step)
    return skeleton("full").as_qpos(level.channels[rows], level.roots[rows])


@pytest.mark.parametrize("level", ["medium", "low"])
def test_hands_and_feet_are_where_those_of_the_master_are(level):
    own = skeleton(level)
    for name in ("walk 1.25", "stand to kneel"):
        found = slaved(frames(name, 15), own, name=name)
        missed = found.missed[:, list(matched(own))]
        assert np.percentile(missed, 95) < TOLERANCES[level]
        assert not found.warnings


def test_what_is_shipped_keeps_to_the_same():
    full = MOTIONS.levels[FULL]
    rows = np.isin(np.arange(len(full.count)), np.flatnonzero(full.count == 1))
    standing = skeleton("full").as_qpos(full.channels[full.first[rows]], full.roots[full.first[rows]])
    for number, level in ((1, "medium"), (2, "low")):
        own, frames_of = skeleton(level), MOTIONS.levels[number]
        mine = own.as_qpos(frames_of.channels[frames_of.first[rows]], frames_of.roots[frames_of.first[rows]])
        off = np.linalg.norm(landmarks_of(mine) - landmarks_of(standing), axis=2)[:, list(matched(own))]
        assert np.percentile(off, 95) < TOLERANCES[level]


def test_the_first_guess_sums_waist_and_chest():
    qpos = np.zeros((1, 46))
    full, low = skeleton("full"), skeleton("low")
    qpos[0, 7 + full.channels.index("waist_pitch")] = 0.2
    qpos[0, 7 + full.channels.index("chest_pitch")] = 0.3
    assert guessed(qpos, low)[0, low.channels.index("waist_pitch")] == pytest.approx(0.5)
    assert np.array_equal(guessed(qpos, full)[0], qpos[0, 7:])


def test_a_held_object_comes_first_and_what_is_out_of_reach_is_told():
    low, qpos = skeleton("low"), np.zeros((1, 46))
    qpos[0, 3] = 1.0
    full = skeleton("full")
    for joint, angle in (("waist_yaw", 0.5), ("chest_yaw", 0.5), ("right_shoulder_flexion", 1.5)):
        qpos[0, 7 + full.channels.index(joint)] = angle
    held, free = slaved(qpos, low, ["right_hand"], "aim"), slaved(qpos, low, name="aim")
    assert held.missed[0, 0] <= free.missed[0, 0]
    assert any("aim, low: right_hand misses by up to" in warning for warning in held.warnings)
    with pytest.raises(LocomotionError, match="landmark 'tail': valid: right_hand"):
        slaved(qpos, low, ["tail"])
